#pragma once

#include <string>
#include <string_view>

#include "furrow_benchmarks/recording_benchmark.hpp"

namespace furrow::benchmarks {

[[nodiscard]] std::string to_text(const RecordingBenchmarkResult& result);
[[nodiscard]] std::string to_json(const RecordingBenchmark& benchmark,
                                  const RecordingBenchmarkResult& result, std::string_view version);

}  // namespace furrow::benchmarks

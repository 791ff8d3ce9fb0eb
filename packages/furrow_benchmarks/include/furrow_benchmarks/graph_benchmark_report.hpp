#pragma once

#include <string>
#include <string_view>

#include "furrow_benchmarks/graph_benchmark.hpp"

namespace furrow::benchmarks {

/// The rows, and below them the ratios that compare paths.
[[nodiscard]] std::string to_text(const GraphBenchmarkResult& result);
[[nodiscard]] std::string to_json(const GraphBenchmark& benchmark,
                                  const GraphBenchmarkResult& result, std::string_view version);

}  // namespace furrow::benchmarks

// Usage: recording_bench FOLDER [MEGABYTES [RUNS]]. Prints a JSON object with a row a run.
#include <cstdio>
#include <cstdlib>

#include "furrow_recording/write_benchmark.hpp"

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: recording_bench FOLDER [MEGABYTES [RUNS]]\n", stderr);
    return 2;
  }
  furrow::recording::WriteBenchmarkOptions options;
  if (argc > 2) {
    options.megabytes = std::strtoull(argv[2], nullptr, 10);
  }
  if (argc > 3) {
    options.runs = static_cast<int>(std::strtol(argv[3], nullptr, 10));
  }
  const auto runs = furrow::recording::benchmark_writing(argv[1], options);
  if (!runs) {
    std::fprintf(stderr, "%s\n", runs.error().message.c_str());
    return 1;
  }
  std::puts("{\"rows\": [");
  for (std::size_t i = 0; i < runs->size(); ++i) {
    const auto& run = (*runs)[i];
    std::printf(
        "  {\"recorder_mbps\": %.0f, \"dd_mbps\": %.0f, \"ratio\": %.3f, \"lost\": %llu}%s\n",
        run.recorder_mbps, run.dd_mbps, run.recorder_mbps / run.dd_mbps,
        static_cast<unsigned long long>(run.dropped), i + 1 < runs->size() ? "," : "");
  }
  std::puts("]}");
  return 0;
}

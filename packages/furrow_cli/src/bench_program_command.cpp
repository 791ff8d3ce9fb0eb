#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "command.hpp"
#include "furrow_core/error.hpp"
#include "verb.hpp"

namespace furrow::cli {
namespace {

struct BenchProgram {
  const char* verb;
  const char* file;
  const char* description;
};

constexpr BenchProgram kPrograms[] = {
    {"tracker", FURROW_TRACKER_BENCH, "Time of one step of the tracker, by plants in view."},
    {"filter", FURROW_FILTER_BENCH, "Time of one step of the localization filter."},
};

/// Becomes the program: its output and its exit code are the command's.
void become(const std::string& file, std::vector<std::string> arguments) {
  if (!std::filesystem::exists(file)) {
    throw ConfigError(file + " was not built; install libbenchmark-dev and build again");
  }
  arguments.insert(arguments.begin(), file);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  execv(file.c_str(), argv.data());
  throw std::system_error(errno, std::generic_category(), file);
}

}  // namespace

void add_bench_program_commands(CLI::App& app, int& /*exit_code*/) {
  CLI::App* bench = group(app, "bench", "Speeds, with the alternative measured beside.");
  for (const BenchProgram& program : kPrograms) {
    CLI::App* verb = bench->add_subcommand(program.verb, program.description);
    verb->footer("Takes Google Benchmark's options, such as --benchmark_filter=TEXT.");
    verb->allow_extras();
    verb->callback([verb, &program] { become(program.file, verb->remaining()); });
  }
}

}  // namespace furrow::cli

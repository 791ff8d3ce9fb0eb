#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "commands.hpp"
#include "furrow_core/error.hpp"

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

/// Replaces this process by the program: its output and its exit code are the command's.
[[noreturn]] void replace_process(const std::string& file, std::vector<std::string> arguments) {
  if (!std::filesystem::exists(file)) {
    throw ConfigError(file + ": was not built; install libbenchmark-dev and build again");
  }
  arguments.insert(arguments.begin(), file);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  execv(file.c_str(), argv.data());
  throw std::system_error(errno, std::generic_category(), file);
}

}  // namespace

void add_bench_program_commands(Command root) {
  for (const BenchProgram& program : kPrograms) {
    Command command = bench_group(root).subcommand(program.verb, program.description);
    command.footer("Takes Google Benchmark's options, such as --benchmark_filter=TEXT.");
    auto arguments = std::make_shared<std::vector<std::string>>();
    command.take_unknown(*arguments);
    command.on_run([&program, arguments]() -> int { replace_process(program.file, *arguments); });
  }
}

}  // namespace furrow::cli

#include "command_line.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iostream>
#include <stdexcept>

#include "furrow_core/error.hpp"

namespace furrow::cli {
namespace {

/// What a command line of one command printed, and its exit code.
struct Outcome {
  int exit_code = 0;
  std::string out;
  std::string error;
};

struct Values {
  bool flag = false;
  std::optional<bool> either;
  int count = 3;
  std::int64_t whole = 0;
  double number = 1.5;
  std::optional<double> maybe;
  std::string text = "default";
  std::vector<std::string> list;
  std::vector<double> origin;
  std::vector<std::string> arguments;
};

Outcome run(
    std::vector<const char*> words, Values& values,
    const std::function<int()>& action = [] { return 0; }) {
  CommandLine command_line("tool", "A tool.", "1.2.3");
  Command command = command_line.root().subcommand("do", "Does it.");
  command.flag("--flag", values.flag, "a flag");
  command.flag("--either,!--no-either", values.either, "one or the other");
  command.option("--count,--alias", values.count, "a count").range(1, 10);
  command.option("--whole", values.whole, "a whole number").at_least(0);
  command.option("--number", values.number, "a number").range(0.5, 2.5);
  command.option("--maybe", values.maybe, "a number").positive();
  command.option("--text", values.text, "a text").choices({"default", "other"});
  command.option("--list", values.list, "texts");
  command.option("--origin", values.origin, "numbers").values(2);
  command.option("arguments", values.arguments, "by position");
  command.on_run(action);
  words.insert(words.begin(), "tool");
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  Outcome result;
  result.exit_code = command_line.run(static_cast<int>(words.size()), words.data());
  std::cout.exceptions(std::ios::goodbit);
  result.error = testing::internal::GetCapturedStderr();
  result.out = testing::internal::GetCapturedStdout();
  return result;
}

Outcome run(std::vector<const char*> words) {
  Values values;
  return run(std::move(words), values);
}

void expect_refused(std::vector<const char*> words, const std::string& part) {
  const Outcome result = run(std::move(words));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.out, "");
  EXPECT_NE(result.error.find(part), std::string::npos) << result.error;
}

TEST(CommandLine, FillsValuesOfEveryKind) {
  Values values;
  bool ran = false;
  const Outcome result =
      run({"do",       "--flag", "--no-either", "--alias=7", "--whole", "4", "--number", "2.5",
           "--maybe",  "0.1",    "--text",      "other",     "--list",  "a", "--list",   "b",
           "--origin", "-1",     "2",           "--",        "x",       "y"},
          values, [&] {
            ran = true;
            return 0;
          });
  EXPECT_EQ(result.exit_code, 0) << result.error;
  EXPECT_TRUE(ran);
  EXPECT_TRUE(values.flag);
  EXPECT_EQ(values.either, false);
  EXPECT_EQ(values.count, 7);
  EXPECT_EQ(values.whole, 4);
  EXPECT_EQ(values.number, 2.5);
  EXPECT_EQ(values.maybe, 0.1);
  EXPECT_EQ(values.text, "other");
  EXPECT_EQ(values.list, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(values.origin, (std::vector<double>{-1.0, 2.0}));
  EXPECT_EQ(values.arguments, (std::vector<std::string>{"x", "y"}));
}

TEST(CommandLine, KeepsDefaultsAndTellsThemInTheHelp) {
  Values values;
  EXPECT_EQ(run({"do"}, values).exit_code, 0);
  EXPECT_EQ(values.count, 3);
  EXPECT_EQ(values.either, std::nullopt);
  EXPECT_EQ(values.maybe, std::nullopt);
  const Outcome help = run({"do", "--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_NE(help.out.find("=default"), std::string::npos) << help.out;
  EXPECT_NE(help.out.find("from 1 to 10"), std::string::npos) << help.out;
}

TEST(CommandLine, RefusesWhatIsOutOfRange) {
  expect_refused({"do", "--count=11"}, "--count: 11 is out of range");
  expect_refused({"do", "--count=0"}, "from 1 to 10");
  expect_refused({"do", "--count=1.5"}, "'1.5' is not a whole number");
  expect_refused({"do", "--whole=-1"},
                 "--whole: -1 is out of range: give a whole number at least 0");
  expect_refused({"do", "--number=2.6"}, "from 0.5 to 2.5");
  expect_refused({"do", "--number=nan"}, "--number: nan is out of range");
  expect_refused({"do", "--maybe=0"}, "--maybe: 0 is out of range: give a number greater than 0");
  expect_refused({"do", "--maybe=inf"}, "--maybe: inf is out of range");
  expect_refused({"do", "--text=none"}, "--text: 'none' is not one of: default, other");
}

TEST(CommandLine, RefusesWhatItDoesNotKnow) {
  expect_refused({}, "");
  expect_refused({"undo"}, "undo");
  expect_refused({"do", "--unknown"}, "--unknown");
}

TEST(CommandLine, ExitCodeTellsHowTheCommandEnded) {
  Values values;
  EXPECT_EQ(run({"do"}, values, [] { return 1; }).exit_code, 1);
  const Outcome bad = run({"do"}, values, []() -> int { throw ConfigError("file:1: key: wrong"); });
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_EQ(bad.error, "tool: file:1: key: wrong\n");
  const Outcome failed = run({"do"}, values, []() -> int { throw std::runtime_error("no disk"); });
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_EQ(failed.error, "tool: no disk\n");
}

TEST(CommandLine, OutputThatCannotBeWrittenIsAnError) {
  std::ofstream full("/dev/full");
  std::streambuf* const kept = std::cout.rdbuf(full.rdbuf());
  Values values;
  const Outcome result = run({"do"}, values, [] {
    std::cout << "text";
    return 0;
  });
  const Outcome help = run({"do", "--help"});
  std::cout.rdbuf(kept);
  std::cout.clear();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.error.find("tool: cannot write to standard output: No space left"),
            std::string::npos)
      << result.error;
  EXPECT_EQ(help.exit_code, 1);
}

}  // namespace
}  // namespace furrow::cli

#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace furrow::cli {

/// An option, a flag or an argument of a command. A handle: copies mean the same option, and it is
/// valid as long as its CommandLine. Each function returns the option, for the next call.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  Option& required();
  /// Numbers from `min` to `max`, both included; NaN is refused.
  template <std::integral Number>
  Option& range(Number min, Number max) {
    return range_of_integers(static_cast<std::int64_t>(min), static_cast<std::int64_t>(max));
  }
  Option& range(double min, double max);
  /// Numbers from `min` on.
  template <std::integral Number>
  Option& at_least(Number min) {
    return range_of_integers(static_cast<std::int64_t>(min), INT64_MAX);
  }
  Option& at_least(double min);
  /// Finite numbers greater than zero.
  Option& positive();
  Option& choices(const std::vector<std::string>& allowed);
  Option& existing_file();
  /// Exactly so many values.
  Option& values(int count);
  /// Leaves the option out of the help.
  Option& hide();

 private:
  Option& range_of_integers(std::int64_t min, std::int64_t max);
  CLI::Option* option_;
};

/// A command, or a group of commands. A handle, as Option is. A value that an option fills must
/// outlive the command line; its value when the option is added is the default and stands in the
/// help. A list takes all values of all uses of its option.
class Command {
 public:
  /// The command of this name; it is added when it is not there yet.
  Command subcommand(const std::string& name, const std::string& description);
  /// A group of commands, one of which must be given.
  Command group(const std::string& name, const std::string& description);

  /// `name` is "--name", or "--name,--alias"; without dashes it is an argument by position.
  Option option(const std::string& name, bool& value, const std::string& description) = delete;
  Option option(const std::string& name, int& value, const std::string& description);
  Option option(const std::string& name, std::int64_t& value, const std::string& description);
  Option option(const std::string& name, std::uint64_t& value, const std::string& description);
  Option option(const std::string& name, double& value, const std::string& description);
  Option option(const std::string& name, std::string& value, const std::string& description);
  Option option(const std::string& name, std::optional<std::int64_t>& value,
                const std::string& description);
  Option option(const std::string& name, std::optional<double>& value,
                const std::string& description);
  Option option(const std::string& name, std::vector<double>& value,
                const std::string& description);
  Option option(const std::string& name, std::vector<std::string>& value,
                const std::string& description);
  /// Switches `value` on.
  Option flag(const std::string& name, bool& value, const std::string& description);
  /// "--name,!--no-name": switches on or off; nothing where neither is given.
  Option flag(const std::string& name, std::optional<bool>& value, const std::string& description);

  /// Whether the user gave the option. After parsing.
  [[nodiscard]] bool given(const std::string& option) const;
  /// Hands what the command does not know to `rest`, in place of an error.
  void take_unknown(std::vector<std::string>& rest);
  /// A line below the help.
  void footer(const std::string& text);
  /// Leaves the command out of the help.
  void hide();

  /// What the command does: the exit code, 0 well, 1 ran but failed or found faults. It may throw
  /// ConfigError for what the user must mend, and std::exception for what failed.
  void on_run(std::function<int()> run);

 private:
  friend class CommandLine;
  Command(CLI::App* app, std::function<int()>* chosen) : app_(app), chosen_(chosen) {}
  CLI::App* app_;
  std::function<int()>* chosen_;  ///< set by the command that the user chose
};

/// The parser behind the commands. Only its source includes the parser's headers, which take longer
/// to compile than any command.
class CommandLine {
 public:
  CommandLine(const std::string& name, const std::string& description, const std::string& version);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  [[nodiscard]] Command root();

  /// Parses and runs the command that was chosen. The exit code: that of the command; 1 when it
  /// failed, or when standard output cannot be written; 2 for bad usage or configuration. Errors
  /// go to standard error. To be called once.
  [[nodiscard]] int run(int argc, const char* const* argv);

 private:
  int parse_and_run(int argc, const char* const* argv);
  std::unique_ptr<CLI::App> app_;
  std::function<int()> chosen_;
};

}  // namespace furrow::cli

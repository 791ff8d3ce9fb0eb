#include "command_line.hpp"

#include <CLI/CLI.hpp>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <exception>
#include <iostream>
#include <limits>
#include <system_error>
#include <utility>

#include "furrow_core/error.hpp"
#include "furrow_core/parameters.hpp"

namespace furrow::cli {
namespace {

constexpr int kFailed = 1;
constexpr int kBadUsage = 2;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <class Number>
std::optional<Number> number_in(const std::string& text) {
  Number value{};
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const char* end = text.data() + text.size();
  const auto parsed = std::from_chars(begin, end, value);
  if (parsed.ec != std::errc() || parsed.ptr != end) return std::nullopt;
  return value;
}

/// A validator that refuses by a sentence; CLI11 puts the option's name before it.
CLI::Validator validator(std::function<std::string(const std::string&)> refusal,
                         const std::string& shown) {
  return CLI::Validator([refusal = std::move(refusal)](std::string& text) { return refusal(text); },
                        shown);
}

CLI::Validator range_of_numbers(double min, double max) {
  const std::string low = to_text(ParameterValue(min));
  const std::string high = to_text(ParameterValue(max));
  const std::string range = max == kInfinity ? "at least " + low : "from " + low + " to " + high;
  return validator(
      [=](const std::string& text) {
        const auto value = number_in<double>(text);
        if (!value) return "'" + text + "' is not a number";
        if (*value >= min && *value <= max && std::isfinite(*value)) return std::string();
        return text + " is out of range: give a number " + range;
      },
      range);
}

template <class Value>
Option add_option(CLI::App* app, const std::string& name, Value& value,
                  const std::string& description) {
  return Option(app->add_option(name, value, description)->capture_default_str());
}

/// Without a default in the help: nothing, or a list.
template <class Value>
Option add_plain_option(CLI::App* app, const std::string& name, Value& value,
                        const std::string& description) {
  return Option(app->add_option(name, value, description));
}

}  // namespace

Option& Option::required() {
  option_->required();
  return *this;
}

Option& Option::range(double min, double max) {
  option_->check(range_of_numbers(min, max));
  return *this;
}

Option& Option::at_least(double min) {
  return range(min, kInfinity);
}

Option& Option::range_of_integers(std::int64_t min, std::int64_t max) {
  const std::string range = max == INT64_MAX
                                ? "at least " + std::to_string(min)
                                : "from " + std::to_string(min) + " to " + std::to_string(max);
  option_->check(validator(
      [=](const std::string& text) {
        const auto value = number_in<std::int64_t>(text);
        if (!value) return "'" + text + "' is not a whole number";
        if (*value >= min && *value <= max) return std::string();
        return text + " is out of range: give a whole number " + range;
      },
      range));
  return *this;
}

Option& Option::positive() {
  option_->check(validator(
      [](const std::string& text) {
        const auto value = number_in<double>(text);
        if (!value) return "'" + text + "' is not a number";
        if (*value > 0.0 && std::isfinite(*value)) return std::string();
        return text + " is out of range: give a number greater than 0";
      },
      "greater than 0"));
  return *this;
}

Option& Option::choices(const std::vector<std::string>& allowed) {
  std::string list;
  for (const std::string& choice : allowed) list += (list.empty() ? "" : ", ") + choice;
  option_->check(validator(
      [=](const std::string& text) {
        for (const std::string& choice : allowed) {
          if (text == choice) return std::string();
        }
        return "'" + text + "' is not one of: " + list;
      },
      list));
  return *this;
}

Option& Option::existing_file() {
  option_->check(CLI::ExistingFile);
  return *this;
}

Option& Option::values(int count) {
  option_->expected(count);
  return *this;
}

Option& Option::hide() {
  option_->group("");
  return *this;
}

Command Command::subcommand(const std::string& name, const std::string& description) {
  const auto known =
      app_->get_subcommands([&](const CLI::App* command) { return command->get_name() == name; });
  return {known.empty() ? app_->add_subcommand(name, description) : known.front(), chosen_};
}

Command Command::group(const std::string& name, const std::string& description) {
  Command command = subcommand(name, description);
  command.app_->require_subcommand(1);
  return command;
}

Option Command::option(const std::string& name, int& value, const std::string& description) {
  return add_option(app_, name, value, description);
}
Option Command::option(const std::string& name, std::int64_t& value,
                       const std::string& description) {
  return add_option(app_, name, value, description);
}
Option Command::option(const std::string& name, std::uint64_t& value,
                       const std::string& description) {
  return add_option(app_, name, value, description);
}
Option Command::option(const std::string& name, double& value, const std::string& description) {
  return add_option(app_, name, value, description);
}
Option Command::option(const std::string& name, std::string& value,
                       const std::string& description) {
  return value.empty() ? add_plain_option(app_, name, value, description)
                       : add_option(app_, name, value, description);
}
Option Command::option(const std::string& name, std::optional<std::int64_t>& value,
                       const std::string& description) {
  return add_plain_option(app_, name, value, description);
}
Option Command::option(const std::string& name, std::optional<double>& value,
                       const std::string& description) {
  return add_plain_option(app_, name, value, description);
}
Option Command::option(const std::string& name, std::vector<double>& value,
                       const std::string& description) {
  return add_plain_option(app_, name, value, description);
}
Option Command::option(const std::string& name, std::vector<std::string>& value,
                       const std::string& description) {
  return value.empty() ? add_plain_option(app_, name, value, description)
                       : add_option(app_, name, value, description);
}

Option Command::flag(const std::string& name, bool& value, const std::string& description) {
  return Option(app_->add_flag(name, value, description));
}
Option Command::flag(const std::string& name, std::optional<bool>& value,
                     const std::string& description) {
  // Unlike add_flag(), this leaves the value empty where the flag is not given.
  return Option(app_->add_flag_function(
      name, [&value](std::int64_t count) { value = count > 0; }, description));
}

bool Command::given(const std::string& option) const {
  return app_->count(option) > 0;
}

void Command::take_unknown(std::vector<std::string>& rest) {
  app_->allow_extras();
  app_->parse_complete_callback([app = app_, &rest] { rest = app->remaining(); });
}

void Command::footer(const std::string& text) {
  app_->footer(text);
}

void Command::hide() {
  app_->group("");
}

void Command::on_run(std::function<int()> run) {
  // Not called within the parser: what a command throws is no error of parsing.
  app_->callback([chosen = chosen_, run = std::move(run)] { *chosen = run; });
}

CommandLine::CommandLine(const std::string& name, const std::string& description,
                         const std::string& version)
    : app_(std::make_unique<CLI::App>(description, name)) {
  app_->set_version_flag("--version", name + " " + version);
  app_->require_subcommand(1);
}

CommandLine::~CommandLine() = default;

Command CommandLine::root() {
  return {app_.get(), &chosen_};
}

int CommandLine::parse_and_run(int argc, const char* const* argv) {
  try {
    app_->parse(argc, argv);
  } catch (const CLI::Success& asked_for_help) {
    return app_->exit(asked_for_help);
  } catch (const CLI::RequiredError& missing) {
    // A misspelt subcommand is missing, and its word remains.
    const std::vector<std::string> unknown = app_->remaining(true);
    std::cerr << app_->get_name() << ": "
              << (unknown.empty() ? missing.what()
                                  : "'" + unknown.front() + "' is not a subcommand or option")
              << "\nRun with --help for more information.\n";
    return kBadUsage;
  } catch (const CLI::ParseError& bad_usage) {
    std::cerr << app_->get_name() << ": " << bad_usage.what()
              << "\nRun with --help for more information.\n";
    return kBadUsage;
  }
  return chosen_ ? chosen_() : 0;
}

int CommandLine::run(int argc, const char* const* argv) {
  const std::string prefix = app_->get_name() + ": ";
  try {
    // The one place that finds an output that cannot be written, whatever the command.
    std::cout.exceptions(std::ios::badbit | std::ios::failbit);
    // A message on standard error must not flush, and fail with, standard output.
    std::cerr.tie(nullptr);
    const int exit_code = parse_and_run(argc, argv);
    std::cout.flush();
    return exit_code;
  } catch (const std::ios_base::failure&) {
    const int reason = errno;
    std::cout.exceptions(std::ios::goodbit);
    std::cerr << prefix
              << "cannot write to standard output: " << std::generic_category().message(reason)
              << '\n';
  } catch (const ConfigError& bad_configuration) {
    std::cerr << prefix << bad_configuration.what() << '\n';
    return kBadUsage;
  } catch (const std::exception& failure) {
    std::cerr << prefix << failure.what() << '\n';
  }
  return kFailed;
}

}  // namespace furrow::cli

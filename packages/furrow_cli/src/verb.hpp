#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace furrow::cli {

/// A verb with verbs of its own, which several files fill: made by the first that asks.
inline CLI::App* group(CLI::App& app, const std::string& name, const std::string& description) {
  const auto there =
      app.get_subcommands([&](const CLI::App* verb) { return verb->get_name() == name; });
  if (!there.empty()) return there.front();
  CLI::App* made = app.add_subcommand(name, description);
  made->require_subcommand(1);
  return made;
}

}  // namespace furrow::cli

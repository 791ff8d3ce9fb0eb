#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "furrow_core/parameters.hpp"

namespace furrow::cli {

/// Adds an option for each parameter of a struct, which the options then fill: "split_mb" becomes
/// --split-mb, with its description, unit, range and choices. The struct must outlive the parsing.
class ParameterOptions final : public ParameterVisitor {
 public:
  /// Parameters named in `leave_out` get no option.
  explicit ParameterOptions(CLI::App& command, std::vector<std::string> leave_out = {})
      : command_(command), leave_out_(std::move(leave_out)) {}

  void visit(const ParameterInfo& info, bool& value) override;
  void visit(const ParameterInfo& info, std::int64_t& value) override;
  void visit(const ParameterInfo& info, double& value) override;
  void visit(const ParameterInfo& info, std::string& value) override;
  void visit(const ParameterInfo& info, std::vector<double>& value) override;
  void visit(const ParameterInfo& info, std::vector<std::string>& value) override;

 private:
  [[nodiscard]] bool wanted(const ParameterInfo& info) const;
  CLI::App& command_;
  std::vector<std::string> leave_out_;
};

}  // namespace furrow::cli

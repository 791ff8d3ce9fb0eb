#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "command_line.hpp"
#include "furrow_core/parameters.hpp"

namespace furrow::cli {

/// Adds an option for each parameter of a struct and lets the command line fill it: "split_mb"
/// becomes --split-mb, with its description, unit, range and choices. The struct must outlive the
/// command line.
class ParameterOptions final : public ParameterVisitor {
 public:
  /// Parameters named in `leave_out` get no option.
  explicit ParameterOptions(Command command, std::vector<std::string> leave_out = {})
      : command_(command), leave_out_(std::move(leave_out)) {}

  void visit(const ParameterInfo& info, bool& value) override;
  void visit(const ParameterInfo& info, std::int64_t& value) override;
  void visit(const ParameterInfo& info, double& value) override;
  void visit(const ParameterInfo& info, std::string& value) override;
  void visit(const ParameterInfo& info, std::vector<double>& value) override;
  void visit(const ParameterInfo& info, std::vector<std::string>& value) override;

 private:
  [[nodiscard]] bool wanted(const ParameterInfo& info) const;
  Command command_;
  std::vector<std::string> leave_out_;
};

}  // namespace furrow::cli

#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "furrow_core/error.hpp"

namespace furrow {

/// Declaration of one parameter.
struct ParameterInfo {
  std::string name = {};  ///< snake_case, with its unit as a suffix where it has one
  std::string unit = {};  ///< "m", "mm2", "m/s"; empty where there is none
  std::string description = {};
  double min = -std::numeric_limits<double>::infinity();  ///< numbers, and each entry of a list
  double max = std::numeric_limits<double>::infinity();
  std::vector<std::string> choices = {};  ///< allowed strings; empty: any
};

/// Reads or writes each parameter of a plain struct. One function of the struct declares all its
/// parameters. Defaults, documentation, validation and loading follow from it. Example:
///
///   struct TrackerParameters {
///     double gate_m = 0.02;
///     void visit(ParameterVisitor& v) {
///       v.visit({.name = "gate_m", .unit = "m", .description = "...", .min = 0.0}, gate_m);
///     }
///   };
class ParameterVisitor {
 public:
  virtual ~ParameterVisitor() = default;
  virtual void visit(const ParameterInfo& info, bool& value) = 0;
  virtual void visit(const ParameterInfo& info, std::int64_t& value) = 0;
  virtual void visit(const ParameterInfo& info, double& value) = 0;
  virtual void visit(const ParameterInfo& info, std::string& value) = 0;
  virtual void visit(const ParameterInfo& info, std::vector<double>& value) = 0;
  virtual void visit(const ParameterInfo& info, std::vector<std::string>& value) = 0;
};

using ParameterValue = std::variant<bool, std::int64_t, double, std::string, std::vector<double>,
                                    std::vector<std::string>>;

/// "bool", "integer", "number", "string", "list of numbers", "list of strings".
[[nodiscard]] std::string type_name(const ParameterValue& value);
/// In the syntax of a parameter file.
[[nodiscard]] std::string to_text(const ParameterValue& value);

struct DeclaredParameter {
  ParameterInfo info;
  ParameterValue default_value;
};

/// A value from a file or the command line, with its source.
struct GivenParameter {
  std::string name;
  ParameterValue value;
  SourceLocation where;
};

/// Lists the parameters of a struct, with its present values as defaults.
class ParameterLister final : public ParameterVisitor {
 public:
  void visit(const ParameterInfo& info, bool& value) override;
  void visit(const ParameterInfo& info, std::int64_t& value) override;
  void visit(const ParameterInfo& info, double& value) override;
  void visit(const ParameterInfo& info, std::string& value) override;
  void visit(const ParameterInfo& info, std::vector<double>& value) override;
  void visit(const ParameterInfo& info, std::vector<std::string>& value) override;

  [[nodiscard]] const std::vector<DeclaredParameter>& declared() const { return declared_; }

 private:
  std::vector<DeclaredParameter> declared_;
};

/// Throws ConfigError when a name is not declared, given twice, of another type or out of range.
/// An integer is accepted where a number is declared.
void check_parameters(const std::vector<DeclaredParameter>& declared,
                      const std::vector<GivenParameter>& given);

/// Assigns the given values to a struct; other parameters keep their defaults. Throws like
/// check_parameters, before the first assignment. Errors name "prefix.key".
class ParameterLoader {
 public:
  template <class Parameters>
  static void load(const std::vector<GivenParameter>& given, Parameters& parameters) {
    ParameterLister lister;
    parameters.visit(lister);
    check_parameters(lister.declared(), given);
    Assigner assigner(given);
    parameters.visit(assigner);
  }

 private:
  class Assigner final : public ParameterVisitor {
   public:
    explicit Assigner(const std::vector<GivenParameter>& given) : given_(given) {}
    void visit(const ParameterInfo& info, bool& value) override;
    void visit(const ParameterInfo& info, std::int64_t& value) override;
    void visit(const ParameterInfo& info, double& value) override;
    void visit(const ParameterInfo& info, std::string& value) override;
    void visit(const ParameterInfo& info, std::vector<double>& value) override;
    void visit(const ParameterInfo& info, std::vector<std::string>& value) override;

   private:
    const std::vector<GivenParameter>& given_;
  };
};

/// Visits a member struct with a prefix before each name. Two members of one type then fit into one
/// struct: `PrefixedVisitor wheel(v, "wheel_"); wheel_parameters.visit(wheel);`
class PrefixedVisitor final : public ParameterVisitor {
 public:
  PrefixedVisitor(ParameterVisitor& inner, std::string prefix)
      : inner_(inner), prefix_(std::move(prefix)) {}
  void visit(const ParameterInfo& info, bool& value) override;
  void visit(const ParameterInfo& info, std::int64_t& value) override;
  void visit(const ParameterInfo& info, double& value) override;
  void visit(const ParameterInfo& info, std::string& value) override;
  void visit(const ParameterInfo& info, std::vector<double>& value) override;
  void visit(const ParameterInfo& info, std::vector<std::string>& value) override;

 private:
  [[nodiscard]] ParameterInfo prefixed(ParameterInfo info) const;
  ParameterVisitor& inner_;
  std::string prefix_;
};

/// The parameters that `Parameters` declares, with their defaults.
template <class Parameters>
[[nodiscard]] std::vector<DeclaredParameter> declared_parameters() {
  Parameters parameters;
  ParameterLister lister;
  parameters.visit(lister);
  return lister.declared();
}

/// Throws ConfigError when a value of the struct is outside its declared range or choices. For
/// parameters that come from a caller and not from ParameterLoader. The error names `where`.
template <class Parameters>
void validate_parameters(Parameters parameters, const SourceLocation& where = {}) {
  ParameterLister lister;
  parameters.visit(lister);
  std::vector<GivenParameter> given;
  given.reserve(lister.declared().size());
  for (const DeclaredParameter& declared : lister.declared()) {
    given.push_back({declared.info.name, declared.default_value, where});
  }
  check_parameters(lister.declared(), given);
}

}  // namespace furrow

#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "furrow_core/parameters.hpp"
#include "furrow_msgs/topics.hpp"

namespace furrow::graph {

enum class Need : std::uint8_t { kRequired, kOptional };

struct PortInfo {
  const msgs::Topic* topic = nullptr;  ///< its name is the port's name, which a graph may remap
  Need need = Need::kRequired;         ///< inputs: whether the graph must publish it
};

/// Ports and parameters of a component class, known without an instance: enough to check a whole
/// graph and to generate its documentation.
class Description {
 public:
  Description& doc(std::string_view text) {
    text_ = text;
    return *this;
  }
  template <class Parameters>
  Description& parameters() {
    parameters_ = declared_parameters<Parameters>();
    return *this;
  }
  /// Parameters that must have the same value in all components of a graph that declare them.
  Description& shared_parameters(std::vector<std::string> names) {
    shared_ = std::move(names);
    return *this;
  }
  template <class T>
  Description& input(Need need = Need::kRequired) {
    inputs_.push_back({&T::topic(), need});
    return *this;
  }
  template <class T>
  Description& output() {
    outputs_.push_back({&T::topic(), Need::kOptional});
    return *this;
  }

  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] const std::vector<DeclaredParameter>& declared_parameters_list() const {
    return parameters_;
  }
  [[nodiscard]] const std::vector<std::string>& shared_parameter_names() const { return shared_; }
  [[nodiscard]] const std::vector<PortInfo>& inputs() const { return inputs_; }
  [[nodiscard]] const std::vector<PortInfo>& outputs() const { return outputs_; }

 private:
  std::string text_;
  std::vector<DeclaredParameter> parameters_;
  std::vector<std::string> shared_;
  std::vector<PortInfo> inputs_;
  std::vector<PortInfo> outputs_;
};

}  // namespace furrow::graph

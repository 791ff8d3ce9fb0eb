#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "furrow_graph/component.hpp"
#include "furrow_graph/context.hpp"
#include "furrow_graph/description.hpp"

namespace furrow::graph {

/// A component class: its description and its factory.
struct ComponentClass {
  std::string name;
  Description description;
  std::function<std::unique_ptr<Component>(Context&)> make;
};

/// The component classes of a process. A library of components exports
///   extern "C" void furrow_register(furrow::graph::Registry& registry) {
///     registry.add<Planner>("planner");
///   }
class Registry {
 public:
  template <class C>
  void add(std::string name) {
    ComponentClass entry{.name = std::move(name)};
    C::describe(entry.description);
    entry.make = [](Context& context) { return std::make_unique<C>(context); };
    add(std::move(entry));
  }
  /// Throws ConfigError if the name is taken.
  void add(ComponentClass entry);

  /// Loads a library, which registers its classes and stays loaded. Loading it again has no effect.
  /// Throws ConfigError with the loader's reason, or if it has no `furrow_register`.
  void load_library(const std::filesystem::path& path);
  /// The class. Loads "libfurrow_component_NAME.so" from the search folders if it is not known yet.
  /// Throws ConfigError with the searched folders.
  const ComponentClass& find(const std::string& name, const SourceLocation& where);
  void add_search_folder(std::filesystem::path folder);

  /// Loads every component library of the search folders, for documentation.
  void load_all();
  [[nodiscard]] std::vector<const ComponentClass*> classes() const;

 private:
  std::map<std::string, ComponentClass> classes_;
  std::vector<std::filesystem::path> folders_;
  std::set<std::filesystem::path> loaded_;
};

}  // namespace furrow::graph

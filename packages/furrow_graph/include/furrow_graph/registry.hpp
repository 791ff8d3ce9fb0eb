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

/// A component class: how it describes itself and how it is made.
struct ComponentClass {
  std::string name;
  Description description;
  std::function<std::unique_ptr<Component>(Context&)> make;
};

/// The component classes that this process knows. A library of components exports
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
  /// Throws ConfigError when the name is taken.
  void add(ComponentClass entry);

  /// Loads a library and lets it register its classes; it stays loaded, and loading
  /// it again does nothing. Throws ConfigError with the
  /// loader's reason, or when `furrow_register` is not in it.
  void load_library(const std::filesystem::path& path);
  /// The class, loading "libfurrow_component_NAME.so" from the search folders when it is not known
  /// yet. Throws ConfigError that names the folders looked at.
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

#pragma once

#include <map>
#include <string>
#include <vector>

#include "furrow_core/parameters.hpp"

namespace furrow::graph {

/// One component of a graph, as the runtime takes it.
struct ComponentSpec {
  std::string name;
  std::string group;  ///< the name in the file; differs from `name` after for_each
  std::string class_name;
  std::string library;             ///< empty: found by the class name
  std::string for_each;            ///< the list to expand over; empty: none
  std::string for_each_parameter;  ///< gets the list's entry
  std::vector<GivenParameter> parameters;
  std::map<std::string, std::string> remaps;  ///< port -> topic
  bool dedicated_thread = false;              ///< in real time
  int priority = 0;  ///< of the dedicated thread under SCHED_FIFO, 1 to 99; 0: no SCHED_FIFO
  SourceLocation where;
  SourceLocation class_where = {};
  std::map<std::string, SourceLocation> remaps_where = {};  ///< by port
  /// Runs in every process of a deployment and publishes nothing that the graph reads.
  bool everywhere = false;
};

/// The components of a graph and their connections. A deployment says where they run.
struct GraphSpec {
  std::string name;
  SourceLocation where;
  std::vector<GivenParameter> common;
  std::vector<std::string> external;
  std::vector<ComponentSpec> components;  ///< in the order of the file
};

/// A process with its components, in the order of the graph.
struct PlacedProcess {
  std::string name;
  std::string host;
  std::vector<std::string> components;
  bool restart = true;
};

}  // namespace furrow::graph

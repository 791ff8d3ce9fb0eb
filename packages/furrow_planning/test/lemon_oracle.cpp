#include "lemon_oracle.hpp"

#include <lemon/network_simplex.h>
#include <lemon/smart_graph.h>

namespace furrow::planning {

long long lemon_min_cost(int nodes, const std::vector<OracleArc>& arcs, int most) {
  lemon::SmartDigraph graph;
  std::vector<lemon::SmartDigraph::Node> node;
  for (int i = 0; i < nodes; ++i) {
    node.push_back(graph.addNode());
  }
  lemon::SmartDigraph::ArcMap<long long> capacity(graph);
  lemon::SmartDigraph::ArcMap<long long> cost(graph);
  for (const OracleArc& given : arcs) {
    const auto arc = graph.addArc(node[given.from], node[given.to]);
    capacity[arc] = given.capacity;
    cost[arc] = given.cost;
  }
  // Axes without a target take this arc.
  const auto idle = graph.addArc(node.front(), node.back());
  capacity[idle] = most;
  cost[idle] = 0;
  lemon::NetworkSimplex<lemon::SmartDigraph, long long, long long> simplex(graph);
  simplex.upperMap(capacity).costMap(cost).stSupply(node.front(), node.back(), most);
  if (simplex.run() != simplex.OPTIMAL) {
    return 1;
  }
  return simplex.totalCost();
}

}  // namespace furrow::planning

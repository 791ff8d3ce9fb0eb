#pragma once

#include <vector>

namespace furrow::planning {

struct OracleArc {
  int from = 0;
  int to = 0;
  long long capacity = 0;
  long long cost = 0;
};

/// Least cost of sending up to `most` units from node 0 to the last one, by LEMON's network
/// simplex; 1 when it finds none. Compiled on its own: LEMON 1.3 is older than C++20.
long long lemon_min_cost(int nodes, const std::vector<OracleArc>& arcs, int most);

}  // namespace furrow::planning

#include "furrow_vision/network_use.hpp"

namespace furrow::vision {

void NetworkUse::visit(ParameterVisitor& v) {
  v.visit({.name = "crop_log_odds",
           .description = "Added to the log-odds of a crop beside what the model file says, where "
                          "crops are more frequent than in training, or dearer",
           .min = -10.0,
           .max = 10.0},
          crop_log_odds);
  v.visit({.name = "input_area_max_px",
           .unit = "px",
           .description = "Larger inputs of the network are scaled down",
           .min = 4096.0,
           .max = 16e6},
          input_area_max_px);
  v.visit({.name = "classes",
           .description = "Names of the classes that the model must have, in order; empty: any"},
          classes);
}

}  // namespace furrow::vision

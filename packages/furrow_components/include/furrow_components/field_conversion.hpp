#pragma once

#include "furrow_core/time.hpp"
#include "furrow_field/field_model.hpp"
#include "furrow_msgs/furrow_msgs.h"

namespace furrow::components {

[[nodiscard]] furrow_msgs::msg::TrueField to_msg(const field::FieldModel& field, Time stamp);
[[nodiscard]] field::FieldModel from_msg(const furrow_msgs::msg::TrueField& message);

}  // namespace furrow::components

#include "furrow_core/version.hpp"

namespace furrow {

std::string_view version() {
  return FURROW_VERSION;
}

}  // namespace furrow

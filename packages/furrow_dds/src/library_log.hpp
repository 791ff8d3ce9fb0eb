#pragma once

namespace furrow::dds {

/// Takes the messages of Fast DDS off standard output, where programs print their results. To be
/// called before a participant is made; further calls do nothing.
void take_over_library_log();

}  // namespace furrow::dds

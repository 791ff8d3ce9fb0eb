#pragma once

#include "command_line.hpp"
#include "furrow_launch/run_options.hpp"

namespace furrow::cli {

/// Adds the options that one process of a run and a supervised run have in common.
void add_run_options(Command command, launch::RunOptions& options);

}  // namespace furrow::cli

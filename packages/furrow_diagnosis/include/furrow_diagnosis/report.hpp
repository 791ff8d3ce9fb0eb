#pragma once

#include <string>

#include "furrow_diagnosis/diagnosis.hpp"

namespace furrow::diagnosis {

/// A table of the inputs, one line per finding, and the checks that were not possible.
[[nodiscard]] std::string report_text(const Observations& seen, const Diagnosis& diagnosis);
/// The same as JSON, for `graph`.
[[nodiscard]] std::string report_json(const std::string& graph, const Observations& seen,
                                      const Diagnosis& diagnosis);

}  // namespace furrow::diagnosis

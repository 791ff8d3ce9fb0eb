#pragma once

#include <filesystem>
#include <string>

#include "furrow_core/output_path.hpp"
#include "furrow_field/field_model.hpp"
#include "furrow_field/statistics.hpp"

namespace furrow::cli {

/// The file of a field model, CSV or GeoJSON by its extension.
class FieldFile {
 public:
  /// Throws ConfigError for another extension, or when the file cannot be written.
  FieldFile(const std::string& path, bool force);
  /// Throws ConfigError for a field that the format cannot hold, std::runtime_error when the file
  /// cannot be written.
  void write(const field::FieldModel& field);
  /// See OutputFile::path().
  [[nodiscard]] const std::filesystem::path& path() const { return file_.path(); }

 private:
  OutputFile file_;
  bool csv_;
};

/// "20.00 m x 1.39 m, 133 crops, 229 weeds, 8.2 weeds/m2". A field narrower than 1 cm has no
/// density: its plants stand on one line.
[[nodiscard]] std::string size_and_counts(const field::FieldModel& field,
                                          const field::FieldStatistics& statistics);

}  // namespace furrow::cli

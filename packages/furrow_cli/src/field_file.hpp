#pragma once

#include <filesystem>
#include <string>

#include "furrow_core/output_path.hpp"
#include "furrow_field/field_model.hpp"

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

}  // namespace furrow::cli

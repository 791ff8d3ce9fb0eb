// Generates C++ from the IDL files, beside the code of fastddsgen:
//
//   furrow_msgs_generator OUTPUT_FOLDER FILE.idl...
#include <algorithm>
#include <iostream>

#include "furrow_core/file.hpp"
#include "generated_code.hpp"

namespace furrow::msgs {
namespace {

Status write(const std::filesystem::path& folder, const std::string& name,
             const GeneratedCode& code) {
  if (Status s = write_file_atomically(folder / (name + ".hpp"), code.header); !s.ok()) return s;
  return write_file_atomically(folder / (name + ".cpp"), code.source);
}

Status generate(const std::filesystem::path& folder, std::vector<std::filesystem::path> paths) {
  std::ranges::sort(paths);
  std::vector<IdlFile> files;
  for (const std::filesystem::path& path : paths) {
    auto file = read_idl_file(path);
    if (!file) return file.error();
    files.push_back(std::move(*file));
  }
  if (Status s = write(folder, "message_types", message_types_code(files)); !s.ok()) return s;
  return write(folder, "enums", enums_code(files));
}

}  // namespace
}  // namespace furrow::msgs

int main(int count, char** arguments) {
  if (count < 3) {
    std::cerr << "usage: furrow_msgs_generator OUTPUT_FOLDER FILE.idl...\n";
    return 2;
  }
  const furrow::Status done =
      furrow::msgs::generate(arguments[1], {arguments + 2, arguments + count});
  if (!done.ok()) std::cerr << "furrow_msgs_generator: " << done.error().message << '\n';
  return done.ok() ? 0 : 1;
}

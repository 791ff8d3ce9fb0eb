#include "furrow_core/scratch_folder.hpp"

#include <stdlib.h>

#include <stdexcept>
#include <string>
#include <system_error>

namespace furrow {

ScratchFolder::ScratchFolder() {
  std::string name =
      (std::filesystem::temp_directory_path() / "furrow_").string() + std::string(6, 'X');
  if (::mkdtemp(name.data()) == nullptr)
    throw std::runtime_error(name + ": cannot make the folder");
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace furrow

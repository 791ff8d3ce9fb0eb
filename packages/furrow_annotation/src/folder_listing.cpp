#include "folder_listing.hpp"

#include <algorithm>
#include <cctype>

namespace furrow::annotation {

Result<std::vector<std::filesystem::path>> list_files(const std::filesystem::path& folder,
                                                      const std::string& extension) {
  std::error_code failure;
  std::vector<std::filesystem::path> files;
  for (std::filesystem::directory_iterator it(folder, failure), end; !failure && it != end;
       it.increment(failure)) {
    std::string own = it->path().extension().string();
    std::transform(own.begin(), own.end(), own.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (own == extension) files.push_back(it->path());
  }
  if (failure) {
    return Error{ErrorCode::kNotFound, folder.string() + ": " + failure.message()};
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace furrow::annotation

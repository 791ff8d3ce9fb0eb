#include "idl_file.hpp"

#include <charconv>
#include <sstream>

#include "furrow_core/file.hpp"

namespace furrow::msgs {
namespace {

constexpr std::string_view kInclude = "#include \"";

struct Flattened {
  std::string included;  ///< the text of the included files
  std::string own;
};

/// The files' text, each file once, an included one before the file that includes it.
Status append_with_includes(const std::filesystem::path& path, std::set<std::string>& seen,
                            Flattened& text, bool own) {
  if (!seen.insert(path.filename().string()).second) return {};
  const auto content = read_file(path);
  if (!content) return content.error();
  std::istringstream lines(*content);
  std::string kept;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(kInclude)) {
      const std::string name = line.substr(kInclude.size(), line.rfind('"') - kInclude.size());
      const Status added = append_with_includes(path.parent_path() / name, seen, text, false);
      if (!added.ok()) return added;
    } else if (!line.starts_with('#')) {
      kept += line + "\n";
    }
  }
  (own ? text.own : text.included) += kept;
  return {};
}

std::string without_comments(const std::string& text) {
  std::istringstream lines(text);
  std::string kept;
  for (std::string line; std::getline(lines, line);) {
    if (const auto comment = line.find("//"); comment != std::string::npos) {
      line.resize(comment);
      line.resize(line.find_last_not_of(" \t") + 1);
    }
    if (!line.empty()) kept += line + "\n";
  }
  return kept;
}

Status check_enumeration(const IdlSchema& schema, const std::string& scoped) {
  std::set<std::string> values;
  for (const IdlConstant& constant : schema.constants_of(scoped)) {
    std::uint8_t value = 0;
    const char* end = constant.value.data() + constant.value.size();
    const auto parsed = std::from_chars(constant.value.data(), end, value);
    if (constant.type != "uint8" || parsed.ec != std::errc() || parsed.ptr != end) {
      return Error{ErrorCode::kParse,
                   scoped + "::" + constant.name + ": must be 'const uint8 NAME = NUMBER;'"};
    }
    if (!values.insert(constant.value).second) {
      return Error{ErrorCode::kParse, scoped + "::" + constant.name + ": the value stands twice"};
    }
  }
  return {};
}

/// Takes a struct of the file itself into `file.names`.
Status add_struct(const std::string& scoped, IdlFile& file) {
  constexpr std::string_view kMiddle = "::msg::";
  const auto at = scoped.find(kMiddle);
  const std::string module = at == std::string::npos ? "" : scoped.substr(0, at);
  if (module.empty() || (!file.module.empty() && module != file.module)) {
    return Error{ErrorCode::kParse,
                 scoped + ": must be in the file's one 'module NAME { module msg {'"};
  }
  if (!file.schema.is_final(scoped)) {
    return Error{ErrorCode::kParse, scoped + ": must be '@final struct'"};
  }
  file.module = module;
  file.names.push_back(scoped.substr(at + kMiddle.size()));
  if (file.schema.is_enumeration(scoped)) return check_enumeration(file.schema, scoped);
  return {};
}

}  // namespace

Result<IdlFile> read_idl_file(const std::filesystem::path& path) {
  const auto named = [&](const Error& error) {
    return Error{error.code, path.string() + ": " + error.message};
  };
  Flattened text;
  std::set<std::string> seen;
  if (const Status read = append_with_includes(path, seen, text, true); !read.ok()) {
    return read.error();
  }
  auto included = IdlSchema::parse(text.included);
  if (!included) return named(included.error());
  auto schema = IdlSchema::parse(text.included + text.own);
  if (!schema) return named(schema.error());
  IdlFile file{.stem = path.stem().string(),
               .text = without_comments(text.included + text.own),
               .schema = std::move(*schema)};
  for (const std::string& scoped : file.schema.struct_names()) {
    if (included->find(scoped) != nullptr) continue;
    if (const Status added = add_struct(scoped, file); !added.ok()) return named(added.error());
  }
  return file;
}

}  // namespace furrow::msgs

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <system_error>

#include "conformance/casefile/casefile.h"
#include "conformance/casefile/json_tree.h"

namespace edgecase::conformance {
namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> fault(const fs::path& file, std::string_view what) {
  return tl::unexpected<Error>({ErrorKind::bad_input, fmt::format("{}: {}", printable(file.string(), 4096), what)});
}

tl::expected<std::string, Error> read_text(const fs::path& file) {
  std::error_code code;
  const fs::file_status status = fs::status(file, code);
  if (status.type() == fs::file_type::not_found) return fault(file, "there is no such file");
  if (status.type() == fs::file_type::none) return fault(file, fmt::format("cannot be read: {}", code.message()));
  if (status.type() == fs::file_type::directory) return fault(file, "is a folder, not a case file");
  // Reading from a pipe or a device could wait for ever.
  if (status.type() != fs::file_type::regular) return fault(file, "is not a regular file");

  const auto close = [](std::FILE* stream) { std::fclose(stream); };
  const std::unique_ptr<std::FILE, decltype(close)> stream(std::fopen(file.c_str(), "rb"), close);
  if (!stream) return fault(file, fmt::format("cannot be read: {}", std::strerror(errno)));
  std::string text;
  std::array<char, 1 << 16> block;
  while (const std::size_t read = std::fread(block.data(), 1, block.size(), stream.get())) {
    text.append(block.data(), read);
    if (text.size() > kMaxCaseBytes)
      return fault(file, fmt::format("is larger than {} bytes, the most a case file may have", kMaxCaseBytes));
  }
  if (std::ferror(stream.get()) != 0) return fault(file, fmt::format("cannot be read: {}", std::strerror(errno)));
  return text;
}

/// Relative to `root`; nothing for a file that does not lie below it.
std::optional<fs::path> below(const fs::path& file, const fs::path& root) {
  const auto absolute = [](const fs::path& path) {
    std::error_code code;
    const fs::path resolved = fs::weakly_canonical(path, code);
    return code ? path.lexically_normal() : resolved;
  };
  const fs::path relative = absolute(file).lexically_relative(absolute(root));
  if (relative.empty() || *relative.begin() == "..") return std::nullopt;
  return relative;
}

}  // namespace

tl::expected<Case, Error> load_case(const fs::path& file, const fs::path& root) {
  const auto text = read_text(file);
  if (!text) return tl::unexpected(text.error());
  const auto relative = below(file, root);
  fs::path name = relative ? *relative : file.lexically_normal();
  if (name.extension() == ".json") name.replace_extension();
  auto result = parse_case(*text, file.string(), name.generic_string());
  if (result && !relative) result->category.clear();
  return result;
}

tl::expected<std::vector<fs::path>, Error> find_cases(const fs::path& root) {
  std::error_code code;
  if (!fs::exists(root, code)) return fault(root, "there is no such folder");
  if (!fs::is_directory(root, code)) return fault(root, "is not a folder");
  std::vector<fs::path> found;
  fs::recursive_directory_iterator entry(root, code);
  for (; !code && entry != fs::recursive_directory_iterator(); entry.increment(code)) {
    const fs::path& path = entry->path();
    if (path.filename().string().starts_with('.')) {
      entry.disable_recursion_pending();
    } else if (path.extension() == ".json") {
      found.push_back(path);
    }
  }
  if (code) return fault(root, fmt::format("cannot be read: {}", code.message()));
  std::sort(found.begin(), found.end(),
            [](const fs::path& a, const fs::path& b) { return a.generic_string() < b.generic_string(); });
  return found;
}

}  // namespace edgecase::conformance

#include "furrow_core/file.hpp"
#include "furrow_ledger/ledger.hpp"
#include "furrow_ledger/report.hpp"

namespace furrow::ledger {

Status write_run_files(const std::filesystem::path& folder, const Ledger& ledger,
                       const RunRecord& record) {
  const std::pair<const char*, std::string> files[] = {
      {"ledger.csv", to_csv(ledger)},
      {"map.svg", map_svg(ledger, record)},
      {"report.html", report_html(ledger, record)},
      // Written last: a folder with a summary is complete.
      {"summary.json", to_json(ledger.summary)}};
  for (const auto& [name, content] : files) {
    if (Status written = write_file_atomically(folder / name, content); !written) return written;
  }
  return {};
}

}  // namespace furrow::ledger

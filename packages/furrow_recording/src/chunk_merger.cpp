#include "chunk_merger.hpp"

#include <algorithm>
#include <utility>

namespace furrow::mcap {

ChunkMerger::ChunkMerger(std::vector<Chunk> chunks, Load load, std::uint64_t max_open_bytes)
    : waiting_(std::move(chunks)), load_(std::move(load)), max_open_bytes_(max_open_bytes) {
  std::ranges::sort(waiting_, [](const Chunk& a, const Chunk& b) {
    return a.start != b.start ? a.start > b.start : a.number > b.number;
  });
}

Result<std::optional<ChunkMerger::Item>> ChunkMerger::next() {
  advance_last();
  while (!waiting_.empty() && (heads_.empty() || waiting_.back().start <= heads_.top().time)) {
    const std::size_t chunk = waiting_.back().number;
    waiting_.pop_back();
    if (Status status = open(chunk); !status) {
      return status.error();
    }
  }
  if (heads_.empty()) {
    return std::optional<Item>();
  }
  const std::size_t chunk = heads_.top().chunk;
  Open& open = open_.at(chunk);
  if (open.records.empty()) {
    if (Status status = reload(chunk, open); !status) {
      heads_.pop();
      open_.erase(chunk);
      return status.error();
    }
  }
  heads_.pop();
  last_ = chunk;
  const ChunkEntry& entry = open.entries[open.next];
  return std::optional(
      Item{chunk, entry.time, ByteView(open.records).subspan(entry.offset, entry.bytes)});
}

Status ChunkMerger::open(std::size_t chunk) {
  Open opened;
  opened.records = std::exchange(spare_, {});
  Status status = load_(chunk, opened.records, &opened.entries);
  if (opened.entries.empty()) {
    spare_ = std::move(opened.records);
    return status;
  }
  std::ranges::stable_sort(opened.entries, {}, &ChunkEntry::time);
  open_bytes_ += opened.records.size();
  heads_.push({opened.entries.front().time, chunk});
  open_.emplace(chunk, std::move(opened));
  keep_within_limit(chunk);
  return status;
}

Status ChunkMerger::reload(std::size_t chunk, Open& open) {
  open.records = std::exchange(spare_, {});
  // Damage was told at the first time. The size is checked: the file may have been changed since.
  (void)load_(chunk, open.records, nullptr);
  const auto fits = [&open](const ChunkEntry& entry) {
    return entry.offset <= open.records.size() && entry.bytes <= open.records.size() - entry.offset;
  };
  if (!std::ranges::all_of(open.entries, fits)) {
    return Error{ErrorCode::kIo, "a chunk has changed while the file was read"};
  }
  open_bytes_ += open.records.size();
  keep_within_limit(chunk);
  return {};
}

void ChunkMerger::advance_last() {
  if (!last_) {
    return;
  }
  const auto at = open_.find(*last_);
  Open& open = at->second;
  if (++open.next < open.entries.size()) {
    heads_.push({open.entries[open.next].time, *last_});
  } else {
    take_records(open);
    open_.erase(at);
  }
  last_.reset();
}

/// Drops the records of the chunks whose next message is due last.
void ChunkMerger::keep_within_limit(std::size_t except) {
  while (open_bytes_ > max_open_bytes_) {
    Open* latest = nullptr;
    for (auto& [chunk, open] : open_) {
      const bool later =
          latest == nullptr || open.entries[open.next].time > latest->entries[latest->next].time;
      if (chunk != except && !open.records.empty() && later) {
        latest = &open;
      }
    }
    if (latest == nullptr) {
      return;
    }
    take_records(*latest);
  }
}

void ChunkMerger::take_records(Open& open) {
  open_bytes_ -= open.records.size();
  spare_ = std::move(open.records);
  open.records = Bytes();
}

}  // namespace furrow::mcap

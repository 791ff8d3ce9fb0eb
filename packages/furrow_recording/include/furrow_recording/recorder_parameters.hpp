#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "furrow_core/parameters.hpp"

namespace furrow::recording {

struct RecorderParameters {
  std::vector<std::string> include = {"*"};
  std::vector<std::string> exclude;
  std::string compression = "zstd";
  std::string schema = "ros2msg";
  std::int64_t chunk_kb = 1024;
  double flush_s = 1.0;
  double split_mb = 0.0;
  double split_s = 0.0;
  double pre_trigger_s = 0.0;
  double pre_trigger_mb = 256.0;
  double min_free_mb = 512.0;
  double queue_mb = 256.0;
  std::int64_t queue_messages = 10000;

  void visit(ParameterVisitor& v) {
    visit_files(v);
    visit_times(v);
    visit_memory(v);
  }

 private:
  void visit_files(ParameterVisitor& v) {
    v.visit({.name = "include", .description = "topics to record, as patterns with * and ?"},
            include);
    v.visit({.name = "exclude", .description = "topics to leave out, before all others"}, exclude);
    v.visit({.name = "compression", .description = "of chunks", .choices = {"none", "lz4", "zstd"}},
            compression);
    v.visit({.name = "schema",
             .description = "language of the message types in the file",
             .choices = {"ros2msg", "omgidl"}},
            schema);
    v.visit({.name = "chunk_kb",
             .unit = "kB",
             .description = "messages that are compressed, checked and written together",
             .min = 4,
             .max = 65536},
            chunk_kb);
  }

  void visit_times(ParameterVisitor& v) {
    v.visit({.name = "flush_s",
             .unit = "s",
             .description = "longest time before a chunk is written; what a killed recorder loses",
             .min = 0.01,
             .max = 3600},
            flush_s);
    v.visit({.name = "split_mb",
             .unit = "MB",
             .description = "begin a new file after this size; 0: never",
             .min = 0,
             .max = 1e6},
            split_mb);
    v.visit({.name = "split_s",
             .unit = "s",
             .description = "begin a new file after this duration; 0: never",
             .min = 0,
             .max = 1e6},
            split_s);
    v.visit({.name = "pre_trigger_s",
             .unit = "s",
             .description = "keep this much in memory and write nothing until triggered; 0: record "
                            "from the start",
             .min = 0,
             .max = 3600},
            pre_trigger_s);
  }

  void visit_memory(ParameterVisitor& v) {
    v.visit({.name = "pre_trigger_mb",
             .unit = "MB",
             .description = "memory for the pre-trigger window; the oldest messages go first",
             .min = 1,
             .max = 65536},
            pre_trigger_mb);
    v.visit({.name = "min_free_mb",
             .unit = "MB",
             .description = "stop, with a whole file, when the disk has less than this left",
             .min = 0,
             .max = 1e6},
            min_free_mb);
    v.visit({.name = "queue_mb",
             .unit = "MB",
             .description = "messages that wait for the recorder; more are dropped and counted",
             .min = 1,
             .max = 65536},
            queue_mb);
    v.visit(
        {.name = "queue_messages", .description = "as queue_mb, by number", .min = 1, .max = 1e6},
        queue_messages);
  }
};

}  // namespace furrow::recording

#!/usr/bin/env python3
"""Writes the files of the MCAP project's conformance set by its published rules.

    generate.py FOLDER

Six inputs are combined with ten optional features of the format (github.com/foxglove/mcap,
tests/conformance), which gives 416 files. FOLDER/expected.tsv lists for each file the messages,
channels, schemas, attachments, metadata records and chunks that it holds.
"""

import argparse
import itertools
import pathlib
import struct
import zlib

MAGIC = b"\x89MCAP0\r\n"
(HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, CHUNK_INDEX, ATTACHMENT,
 ATTACHMENT_INDEX, STATISTICS, METADATA, METADATA_INDEX, SUMMARY_OFFSET, DATA_END) = range(1, 16)

CHUNKS, MESSAGE_INDEXES, REPEATED_CHANNELS, REPEATED_SCHEMAS = "ch", "mx", "rch", "rsh"
ATTACHMENT_INDEXES, METADATA_INDEXES, CHUNK_INDEXES = "ax", "mdx", "chx"
STATISTICS_RECORD, SUMMARY_OFFSETS, PADDING = "st", "sum", "pad"
FEATURES = [CHUNKS, MESSAGE_INDEXES, STATISTICS_RECORD, REPEATED_SCHEMAS, REPEATED_CHANNELS,
            ATTACHMENT_INDEXES, METADATA_INDEXES, CHUNK_INDEXES, SUMMARY_OFFSETS, PADDING]
# These records have a fixed length, or end with data of any length.
NEVER_PADDED = {FOOTER, MESSAGE, CHUNK, DATA_END}

EXAMPLE_SCHEMA = (SCHEMA, {"id": 1, "name": "Example", "encoding": "c", "data": b"\x04\x05\x06"})


def channel(schema, encoding, metadata):
    return CHANNEL, {"id": 1, "schema": schema, "topic": "example", "encoding": encoding,
                     "metadata": metadata}


def message(sequence, log_time, publish_time):
    return MESSAGE, {"channel": 1, "sequence": sequence, "log_time": log_time,
                     "publish_time": publish_time, "data": b"\x01\x02\x03"}


EXAMPLE_CHANNEL = channel(1, "a", {"foo": "bar"})
INPUTS = {
    "NoData": [],
    "OneSchemalessMessage": [channel(0, "text", {}), message(10, 2, 1)],
    "OneMessage": [EXAMPLE_SCHEMA, EXAMPLE_CHANNEL, message(10, 2, 1)],
    "OneAttachment": [(ATTACHMENT, {"name": "myFile", "media_type": "application/octet-stream",
                                    "log_time": 2, "create_time": 1, "data": b"\x01\x02\x03"})],
    "OneMetadata": [(METADATA, {"name": "myMetadata", "values": {"foo": "bar"}})],
    "TenMessages": [EXAMPLE_SCHEMA, EXAMPLE_CHANNEL,
                    *(message(i, t, t) for i, t in enumerate([0, 2, 1, 3, 3, 5, 4, 7, 8, 9]))],
}


def string(text):
    data = text if isinstance(text, bytes) else text.encode()
    return struct.pack("<I", len(data)) + data


def string_map(values):
    entries = b"".join(string(key) + string(value) for key, value in values.items())
    return string(entries)


def content(opcode, r):
    """A record's fields in bytes."""
    if opcode == SCHEMA:
        return (struct.pack("<H", r["id"]) + string(r["name"]) + string(r["encoding"]) +
                string(r["data"]))
    if opcode == CHANNEL:
        return (struct.pack("<HH", r["id"], r["schema"]) + string(r["topic"]) +
                string(r["encoding"]) + string_map(r["metadata"]))
    if opcode == MESSAGE:
        return struct.pack("<HIQQ", r["channel"], r["sequence"], r["log_time"],
                           r["publish_time"]) + r["data"]
    if opcode == ATTACHMENT:
        fields = (struct.pack("<QQ", r["log_time"], r["create_time"]) + string(r["name"]) +
                  string(r["media_type"]) + struct.pack("<Q", len(r["data"])) + r["data"])
        return fields + struct.pack("<I", zlib.crc32(fields))
    assert opcode == METADATA
    return string(r["name"]) + string_map(r["values"])


class File:
    """One file with its features."""

    def __init__(self, records, features):
        self.records = records
        self.features = features
        self.bytes = bytearray(MAGIC)

    def put(self, opcode, data, into=None):
        """Appends a record and returns its offset and length."""
        target = self.bytes if into is None else into
        if PADDING in self.features and opcode not in NEVER_PADDED and into is None:
            data += b"\x01\xff\xff"
        offset = len(target)
        target += struct.pack("<BQ", opcode, len(data)) + data
        return offset, len(target) - offset

    def messages(self):
        return [fields for opcode, fields in self.records if opcode == MESSAGE]

    def times(self):
        times = [fields["log_time"] for fields in self.messages()]
        return (min(times), max(times)) if times else (0, 0)

    def count(self, opcode):
        return sum(1 for kind, _ in self.records if kind == opcode)

    def build(self):
        self.put(HEADER, string("") + string(""))
        self.attachments, self.metadata, self.chunks = [], [], []
        in_chunk = bytearray() if CHUNKS in self.features else None
        index = []
        for opcode, fields in self.records:
            if opcode in (SCHEMA, CHANNEL, MESSAGE):
                offset, _ = self.put(opcode, content(opcode, fields), in_chunk)
                if opcode == MESSAGE:
                    index.append((fields["log_time"], offset))
            else:
                place = self.put(opcode, content(opcode, fields))
                (self.attachments if opcode == ATTACHMENT else self.metadata).append(
                    (fields, *place))
        if in_chunk is not None:
            self.put_chunk(bytes(in_chunk), index)
        self.put(DATA_END, struct.pack("<I", zlib.crc32(self.bytes)))
        self.put_end()
        return bytes(self.bytes)

    def put_chunk(self, records, index):
        start, end = self.times()
        offset, length = self.put(CHUNK, struct.pack(
            "<QQQI", start, end, len(records), zlib.crc32(records)) + string("") +
            struct.pack("<Q", len(records)) + records)
        indexed, index_length = {}, 0
        if MESSAGE_INDEXES in self.features and index:
            entries = b"".join(struct.pack("<QQ", *entry) for entry in index)
            at, index_length = self.put(MESSAGE_INDEX, struct.pack("<H", 1) + string(entries))
            indexed[1] = at
        offsets = b"".join(struct.pack("<HQ", *entry) for entry in indexed.items())
        self.chunks.append(struct.pack("<QQQQ", start, end, offset, length) + string(offsets) +
                           struct.pack("<Q", index_length) + string("") +
                           struct.pack("<QQ", len(records), len(records)))

    def statistics(self):
        count = len(self.messages())
        counts = struct.pack("<HQ", 1, count) if count else b""
        return struct.pack("<QHIIIIQQ", count, self.count(SCHEMA), self.count(CHANNEL),
                           self.count(ATTACHMENT), self.count(METADATA),
                           1 if CHUNKS in self.features else 0, *self.times()) + string(counts)

    def groups(self):
        """The groups of the summary, with their records."""
        def repeated(opcode, feature):
            return [content(kind, fields) for kind, fields in self.records
                    if kind == opcode and feature in self.features]

        yield SCHEMA, repeated(SCHEMA, REPEATED_SCHEMAS)
        yield CHANNEL, repeated(CHANNEL, REPEATED_CHANNELS)
        yield STATISTICS, [self.statistics()] if STATISTICS_RECORD in self.features else []
        yield METADATA_INDEX, [
            struct.pack("<QQ", offset, length) + string(fields["name"])
            for fields, offset, length in self.metadata if METADATA_INDEXES in self.features]
        yield ATTACHMENT_INDEX, [
            struct.pack("<QQQQQ", offset, length, fields["log_time"], fields["create_time"],
                        len(fields["data"])) + string(fields["name"]) + string(fields["media_type"])
            for fields, offset, length in self.attachments if ATTACHMENT_INDEXES in self.features]
        yield CHUNK_INDEX, self.chunks if CHUNK_INDEXES in self.features else []

    def put_end(self):
        start = len(self.bytes)
        places = []
        for opcode, records in self.groups():
            at = len(self.bytes)
            for record in records:
                self.put(opcode, record)
            if records:
                places.append((opcode, at, len(self.bytes) - at))
        has_summary = bool(places)
        offsets = 0
        if SUMMARY_OFFSETS in self.features:
            offsets = len(self.bytes)
            for place in places:
                self.put(SUMMARY_OFFSET, struct.pack("<BQQ", *place))
        footer = struct.pack("<QQ", start if has_summary else 0, offsets)
        checked = self.bytes[start:] + struct.pack("<BQ", FOOTER, 20) + footer
        self.put(FOOTER, footer + struct.pack("<I", zlib.crc32(checked)))
        self.bytes += MAGIC


def makes_sense(opcodes, features):
    """True when each feature has something to apply to."""
    needs = [(ATTACHMENT_INDEXES, ATTACHMENT), (METADATA_INDEXES, METADATA),
             (REPEATED_SCHEMAS, SCHEMA), (REPEATED_CHANNELS, CHANNEL)]
    if any(feature in features and opcode not in opcodes for feature, opcode in needs):
        return False
    if not opcodes & {MESSAGE, CHANNEL, SCHEMA} and features & {CHUNKS, CHUNK_INDEXES,
                                                                MESSAGE_INDEXES}:
        return False
    if SUMMARY_OFFSETS in features and not features & {
            CHUNK_INDEXES, REPEATED_SCHEMAS, REPEATED_CHANNELS, METADATA_INDEXES,
            ATTACHMENT_INDEXES, STATISTICS_RECORD}:
        return False
    return CHUNKS in features or not features & {CHUNK_INDEXES, MESSAGE_INDEXES}


def variants():
    for name, records in INPUTS.items():
        opcodes = {opcode for opcode, _ in records}
        for size in range(len(FEATURES) + 1):
            for features in itertools.combinations(FEATURES, size):
                if makes_sense(opcodes, set(features)):
                    yield "-".join([name, *sorted(features)]), records, set(features)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    folder = parser.parse_args().folder
    folder.mkdir(parents=True, exist_ok=True)
    lines = []
    for name, records, features in variants():
        file = File(records, features)
        (folder / f"{name}.mcap").write_bytes(file.build())
        counts = [file.count(opcode) for opcode in (MESSAGE, CHANNEL, SCHEMA, ATTACHMENT, METADATA)]
        counts.append(1 if CHUNKS in features else 0)
        lines.append("\t".join([name, *map(str, counts)]) + "\n")
    (folder / "expected.tsv").write_text("".join(lines))


if __name__ == "__main__":
    main()

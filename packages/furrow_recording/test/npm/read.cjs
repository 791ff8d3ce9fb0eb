// Reads MCAP files with @mcap/core, every CRC checked, in a stream and by the index, and decodes each
// message by the schema in the file. Prints a line per message: topic, log time, content as JSON.
// Usage: node read.cjs FILE...
"use strict";

const fs = require("fs");
const { McapIndexedReader, McapStreamReader } = require("@mcap/core");
const { parseIDL } = require("@foxglove/omgidl-parser");
const { MessageReader: IdlReader } = require("@foxglove/omgidl-serialization");
const { parse: parseRosmsg } = require("@foxglove/rosmsg");
const { MessageReader: RosReader } = require("@foxglove/rosmsg2-serialization");
const zstd = require("@foxglove/wasm-zstd");
const lz4 = require("@foxglove/wasm-lz4");

function decoder(schema) {
  const text = new TextDecoder().decode(schema.data);
  if (schema.encoding === "ros2msg") {
    return new RosReader(parseRosmsg(text, { ros2: true }));
  }
  if (schema.encoding === "omgidl") {
    return new IdlReader(schema.name, parseIDL(text));
  }
  throw new Error(`schema ${schema.name} has the encoding '${schema.encoding}'`);
}

function plain(key, value) {
  if (typeof value === "bigint") {
    return value.toString();
  }
  return ArrayBuffer.isView(value) ? Array.from(value) : value;
}

function fileReadable(bytes) {
  return {
    size: async () => BigInt(bytes.length),
    read: async (offset, size) => {
      const part = bytes.subarray(Number(offset), Number(offset + size));
      if (part.length !== Number(size)) {
        throw new Error("read beyond the end of the file");
      }
      return new Uint8Array(part);
    },
  };
}

function streamed(bytes, decompressHandlers) {
  const reader = new McapStreamReader({ validateCrcs: true, decompressHandlers });
  reader.append(bytes);
  const messages = [];
  for (let record; (record = reader.nextRecord()); ) {
    if (record.type === "Message") {
      messages.push(record);
    }
  }
  if (!reader.done()) {
    throw new Error("the file does not end as it should");
  }
  return messages;
}

async function read(file, decompressHandlers) {
  const bytes = fs.readFileSync(file);
  const inFile = streamed(bytes, decompressHandlers);
  const reader = await McapIndexedReader.Initialize({
    readable: fileReadable(bytes),
    decompressHandlers,
  });
  const decoders = new Map();
  let count = 0;
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    const channel = reader.channelsById.get(message.channelId);
    if (channel.messageEncoding !== "cdr") {
      throw new Error(`${channel.topic} has the encoding '${channel.messageEncoding}'`);
    }
    if (!decoders.has(channel.schemaId)) {
      decoders.set(channel.schemaId, decoder(reader.schemasById.get(channel.schemaId)));
    }
    const content = decoders.get(channel.schemaId).readMessage(message.data);
    console.log(channel.topic, message.logTime.toString(), JSON.stringify(content, plain));
    ++count;
  }
  if (count !== inFile.length || BigInt(count) !== reader.statistics.messageCount) {
    throw new Error(`${inFile.length} messages in the stream, ${count} by the index, ` +
      `${reader.statistics.messageCount} by the statistics`);
  }
}

async function main() {
  await zstd.isLoaded;
  await lz4.isLoaded;
  const decompressHandlers = {
    lz4: (data, size) => lz4(data, Number(size)),
    zstd: (data, size) => zstd.decompress(data, Number(size)),
  };
  for (const file of process.argv.slice(2)) {
    await read(file, decompressHandlers);
  }
}

main().catch((error) => {
  console.error(error.message);
  process.exitCode = 1;
});

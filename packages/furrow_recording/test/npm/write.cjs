// Writes an MCAP file with @mcap/core: std_msgs/msg/String "text N" on /text at N ms, and a metadata
// record and an attachment. Usage: node write.cjs FILE MESSAGES chunks|loose none|zstd
"use strict";

const fs = require("fs");
const { McapWriter } = require("@mcap/core");
const { parse: parseRosmsg } = require("@foxglove/rosmsg");
const { MessageWriter } = require("@foxglove/rosmsg2-serialization");
const zstd = require("@foxglove/wasm-zstd");

async function main() {
  const [path, messages, layout, compression] = process.argv.slice(2);
  await zstd.isLoaded;
  const file = fs.openSync(path, "wx");
  let position = 0n;
  const writer = new McapWriter({
    writable: {
      position: () => position,
      write: async (bytes) => {
        fs.writeSync(file, bytes);
        position += BigInt(bytes.length);
      },
    },
    useChunks: layout === "chunks",
    chunkSize: 2000,
    compressChunk:
      compression === "zstd"
        ? (data) => ({ compression: "zstd", compressedData: zstd.compress(data) })
        : undefined,
  });
  await writer.start({ profile: "ros2", library: "" });
  // Before the messages: behind loose ones @mcap/core 2.2.2 writes wrong indexes of these.
  await writer.addMetadata({ name: "origin", metadata: new Map([["writer", "@mcap/core"]]) });
  await writer.addAttachment({
    name: "note",
    mediaType: "text/plain",
    logTime: 1n,
    createTime: 2n,
    data: new TextEncoder().encode("attached"),
  });
  const definition = "string data\n";
  const schemaId = await writer.registerSchema({
    name: "std_msgs/msg/String",
    encoding: "ros2msg",
    data: new TextEncoder().encode(definition),
  });
  const channelId = await writer.registerChannel({
    schemaId,
    topic: "/text",
    messageEncoding: "cdr",
    metadata: new Map([["offered_qos_profiles", "- reliability: 1\n  durability: 1\n  depth: 3"]]),
  });
  const encoder = new MessageWriter(parseRosmsg(definition, { ros2: true }));
  for (let i = 0; i < Number(messages); ++i) {
    const time = BigInt(i) * 1_000_000n;
    await writer.addMessage({
      channelId,
      sequence: i,
      logTime: time,
      publishTime: time,
      data: encoder.writeMessage({ data: `text ${i}` }),
    });
  }
  await writer.end();
  fs.closeSync(file);
}

main().catch((error) => {
  console.error(error.message);
  process.exitCode = 1;
});

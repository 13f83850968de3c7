// A worker of a pool, which has an index and answers parts of batches.

import { Index, init } from "./index.js";
import { nodeModule } from "./module.js";
import type { Call, Start } from "./pool.js";

const parent = nodeModule("node:worker_threads")?.parentPort;
const reply: (message: unknown) => void =
  parent ? (message) => parent.postMessage(message) : (message) => postMessage(message);

let index: Index;

async function receive(message: Start | Call): Promise<void> {
  try {
    if ("saved" in message) {
      await init(message.module);
      index = Index.load(message.saved);
      reply({});
      return;
    }
    const { method, queries, out, options } = message;
    if (method === "closestPoints") index.closestPoints(queries, out, options);
    else index[method](queries, out.answer!, options);
    reply({ out });
  } catch (error) {
    reply({ error: (error as Error).message });
  }
}

if (parent) parent.on("message", receive);
else onmessage = ({ data }) => receive(data);

// A worker of live queries: it has the module of WebAssembly with the scene and an index. Each message calls one of the
// functions below, in order, and is answered by its result.

// The milliseconds for which the queries of an index are measured, after a warm-up of the same length, in which the
// browser compiles them.
const MEASURED_TIME = 100;

let module;

const FUNCTIONS = {
  // Loads the module and the scene, before any other call, and returns whether the arrays of the scene fit each other.
  async load({ module: bytes, coordinates, sizes, indices }) {
    const { instance } = await WebAssembly.instantiate(bytes, {});
    module = instance.exports;
    [coordinates, sizes, indices].forEach((array, number) => {
      const address = module.p2m_reserve(number, array.length);
      new array.constructor(module.memory.buffer, address, array.length).set(array);
    });
    return module.p2m_load() !== 0;
  },

  // Builds an index. Its size is 0 if this index is not built for such a scene.
  build(number) {
    const start = performance.now();
    const bytes = module.p2m_build(number);
    return { bytes, time: performance.now() - start };
  },

  // Returns the number of queries per second at points around the scene.
  measure(number) {
    measureRate(number);
    return measureRate(number);
  },

  // Builds the scene far from the origin, and returns its scale, or 0 if there is none.
  buildFar: () => module.p2m_build_far(),

  // Returns the answer of an index to a query, or `null` if there is none.
  query: readAnswer,

  // Returns the answer to a query far from the origin.
  queryFar: readFarAnswer,
};

function readAnswer(number, query) {
  if (module.p2m_query(number, ...query) === 0) return null;
  const [x, y, z, distance, lowerBound, primitive, feature, ...work] = lastValues(10);
  return { point: [x, y, z], distance, lowerBound, primitive, feature, work };
}

function readFarAnswer(query) {
  if (module.p2m_query_far(...query) === 0) return null;
  const values = lastValues(12);
  const part = (at) => ({ point: values.slice(at, at + 3), distance: values[at + 3] });
  const [exact, p2m, ordinary] = [0, 4, 8].map(part);
  return { query: exact.point, distance: exact.distance, p2m, ordinary };
}

function lastValues(length) {
  return [...new Float64Array(module.memory.buffer, module.p2m_answer(), length)];
}

function measureRate(number) {
  let [answered, size, start, time] = [0, 64, performance.now(), 0];
  while (time < MEASURED_TIME) {
    answered += module.p2m_answer_many(number, size);
    time = performance.now() - start;
    size *= 2;
  }
  return answered / (time / 1000);
}

onmessage = async ({ data: { name, values } }) => {
  try {
    postMessage({ result: await FUNCTIONS[name](...values) });
  } catch (error) {
    postMessage({ error: error.message });
  }
};

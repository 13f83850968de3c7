import { defineConfig } from "vitest/config";

// The machine may have other work, and a test without an end fails all the same.
export default defineConfig({ test: { testTimeout: 120_000, hookTimeout: 120_000 } });

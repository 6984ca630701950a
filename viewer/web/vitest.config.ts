import {defineConfig} from 'vitest/config';

export default defineConfig({
  test: {
    include: ['test/core/*.test.ts', 'test/volume/*.test.ts'],
    benchmark: {include: ['test/core/*.bench.ts']},
    environment: 'node',
  },
});

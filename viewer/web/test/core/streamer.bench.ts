import {bench, describe} from 'vitest';
import {flightOverManyTiles} from './flight_over_many_tiles';

describe('Streamer', async () => {
  const {fly} = await flightOverManyTiles();
  let frames = 0;
  bench('a frame among 100,000 tiles', () => void fly(60 + 0.01 * ++frames));
});

let failureCount = 0;

/** Prints one line for a check. */
export function check(holds, text) {
  console.log(`${holds ? 'ok  ' : 'FAIL'} ${text}`);
  if (!holds) ++failureCount;
}

/** Checks so far that do not hold. */
export function failures() {
  return failureCount;
}

/** Runs each test by its name; says which does not hold, and lets the process end with 1. */
export function check(tests) {
  for (const [name, test] of Object.entries(tests)) {
    try {
      test();
    } catch (error) {
      console.log(`${name}: ${error.message}`);
      process.exitCode = 1;
    }
  }
}

# Sourced by .ci/run and tests/nightly: jobs that go on when one fails, and a table of them at the end.

jobs=() failures=()

# job NAME COMMAND...: runs the command; keeps its verdict, its time, its output in build/logs/ and, where it failed, why.
job() {
  local name=$1 start=$SECONDS verdict=ok log="build/logs/$1.log"
  shift
  mkdir -p build/logs
  printf '\n=== %s\n' "$name"
  "$@" 2>&1 | tee "$log" || { verdict=FAILED; failures+=("=== $name" "$(why "$log")"); }
  jobs+=("$(printf '%-22s %-7s %5d s' "$name" "$verdict" $((SECONDS - start)))")
}

# why LOG: what the failed tests printed and CTest's list of them, or else the end of the log.
why() {
  awk '/ Test +#[0-9]+: /{ print_it = /\*\*\*(Failed|Timeout|Exception)/ } /tests FAILED:$/{ print_it = 1 } print_it' "$1" | grep . || tail -n 30 "$1"
}

# finish: why jobs failed, then a line a job, last so that whoever reads only the end reads it. Fails if a job failed.
finish() {
  ((${#failures[@]} == 0)) || printf '\n%s\n' "${failures[@]}" | tail -n 200
  printf '\n=== summary\n'
  printf '%s\n' "${jobs[@]}"
  ((${#failures[@]} == 0))
}

# sanitized PRESET "TARGET..." CTEST-ARGUMENT...: builds the targets under a sanitizer and runs the tests chosen.
sanitized() {
  local preset=$1 targets
  read -r -d '' -a targets <<< "$2" || true  # words of all lines
  shift 2
  configure "$preset" -DWEFT_BUILD_PAGE=OFF &&
    cmake --build --preset "$preset" --parallel "$(nproc)" --target "${targets[@]}" &&
    ctest --preset "$preset" --parallel "$(($(nproc) + 1))" -E "$not_sanitized" "$@"
}

# What no sanitizer job builds.
not_sanitized='^(kernel|record|baseline)_test'
asan_targets='weft cloth_test scene_test fabric_test library_test study_test host_test protocol_tests output_test
weft_test_modules stability_test random_scenes_test stability_table'
tsan_targets='weft cloth_threads_test host_threads_test'

check_format() { git ls-files '*.h' '*.cpp' | xargs clang-format --dry-run --Werror; }

# Sourced by ./run: what is too long for its tests, for hours on end. Uses its helpers.
# shellcheck shell=bash disable=SC2154

# closeSoak PART TEXT CODE: remembers how a part went for closeTests.
closeSoak() {
  [[ $3 -eq 0 ]] || failed=1
  outcomes+=("$(printf '%-14s %-6s %s' "$1" "$([[ $3 -eq 0 ]] && echo holds || echo FAILS)" "$2")")
}

# What libFuzzer is told of each target: the longest input (bytes) and more.
declare -A fuzz_options=(
  [scene]="-max_len=1500 -dict=out/soak/fuzz/scene.dict"
  [set]="-max_len=300 -dict=out/soak/fuzz/scene.dict"
  [slim]="-max_len=1500"
  [obj]="-max_len=400"
  [mesh]="-max_len=400"
  [points]="-max_len=200"
  [save]="-max_len=6000"
)

# fuzz TARGET EXECUTIONS: new inputs are kept in out/soak/fuzz/TARGET/corpus, from where the next run goes on.
fuzz() {
  local target=$1 executions=$2 out=out/soak/fuzz/$1 code=0 start=$SECONDS scratch
  say "Fuzzing $target, $executions executions"
  mkdir -p "$out/corpus"
  # The readers of files get theirs in memory where that is possible.
  scratch=$(mktemp -d -p "$([[ -w /dev/shm ]] && echo /dev/shm || echo "${TMPDIR:-/tmp}")")
  # shellcheck disable=SC2086  # options are words
  TMPDIR=$scratch build/fuzz/tests/fuzz/fuzz_$target -runs="$executions" ${fuzz_options[$target]} -timeout=20 -rss_limit_mb=4096 -detect_leaks=0 \
    -artifact_prefix="$out/" -print_final_stats=1 -verbosity=1 "$out/corpus" "tests/fuzz/corpus/$target" \
    >"$out/log" 2>&1 || code=$?
  rm -r "$scratch"
  local made
  made=$(sed -n 's/^stat::number_of_executed_units: *//p' "$out/log")
  [[ $code -eq 0 ]] || tail -n 30 "$out/log"
  closeSoak "fuzz $target" "${made:-no} executions, $((SECONDS - start)) s, $out/log" "$code"
}

soak_fuzz() {
  setup soak
  configureAndBuild fuzz
  mkdir -p out/soak/fuzz
  # Every word of scene files.
  grep -oE '"[a-z_0-9]+"' scenes/scene.schema.json | sort -u | sed 's/"//g; s/.*/"&"/' >out/soak/fuzz/scene.dict
  local target
  for target in scene set slim mesh points save obj; do fuzz "$target" "${1:-1000000}"; done
}

# hardCases PART FILTER: tests of hard_case_tests, spread over the processors.
hardCases() {
  local part=$1 filter=$2 code=0 start=$SECONDS shard log=out/soak/$1
  local pids=()
  # Meshes are fitted once, by this program.
  rm -rf out/soak/cache
  for ((shard = 0; shard < jobs; ++shard)); do
    GTEST_TOTAL_SHARDS=$jobs GTEST_SHARD_INDEX=$shard MIGIWA_CACHE=$PWD/out/soak/cache \
      build/dev/tests/hard_cases/hard_case_tests --gtest_filter="$filter" >"$log.$shard.log" 2>&1 &
    pids+=($!)
  done
  for shard in "${pids[@]}"; do wait "$shard" || code=1; done
  cat "$log".*.log | grep -E '^\[  (PASSED|FAILED)  \]' || true
  local passed
  passed=$(cat "$log".*.log | grep -c '^\[       OK \]' || true)
  closeSoak "$part" "$passed tests hold, $((SECONDS - start)) s, $log.*.log" "$code"
}

soak_scenes() {
  configureAndBuild dev hard_case_tests
  say "${1:-3000} random scenes"
  MIGIWA_RANDOM_SCENES=${1:-3000} hardCases scenes '*RandomScenes*'
}

soak_hard() {
  configureAndBuild dev hard_case_tests
  say "Every hard case with every method of gamma and 1 to 64 threads, and a million steps of rest"
  MIGIWA_SOAK=1 hardCases hard '-*RandomScenes*'
}

soak_window() {
  configureAndBuild release
  local code=0 log=out/soak/window.log
  say "The window, driven at random for ${1:-600} s"
  xvfb-run -a -s "-screen 0 1400x900x24" /usr/bin/python3 tests/render/drive_window.py . "$PWD/$migiwa" "${1:-600}" | tee "$log" || code=1
  closeSoak window "$(tail -n 1 "$log")" "$code"
}

# Each part may be named, alone or with others, and with a number of its own: fuzz=1000.
command_soak() {
  local part parts=("$@")
  [[ $# -gt 0 ]] || parts=(fuzz scenes hard window)
  for part in "${parts[@]}"; do
    [[ $part =~ ^(fuzz|scenes|hard|window)(=[0-9]+)?$ ]] ||
      fail "expected fuzz, scenes, hard or window, each with =NUMBER if you like, found $part"
  done
  setup build test
  mkdir -p out/soak
  for part in "${parts[@]}"; do
    if [[ $part == *=* ]]; then "soak_${part%=*}" "${part#*=}"; else "soak_$part"; fi
  done
  closeTests
}

#!/bin/sh
# check.sh SOURCE BUILD SAMPLE: ./check counts the cases of all suites and goes on after a failed one; time limits follow the factor.
# SAMPLE is the program of framework/sample_cases.c.
set -eu
source=$1 build=$2 sample=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
bad=0
# expect NAME TEXT FILE: the file has that line.
expect() { grep -qxF -e "$2" "$3" || { echo "$1: no line '$2' in:"; cat "$3"; bad=1; }; }

"$sample" >"$folder/sample" 2>&1 && { echo "a failed case is no failure"; bad=1; }
expect "outcomes of a program" "cases: 1 passed, 1 failed, 3 skipped (no sample: 2, no example: 1)" "$folder/sample"

limit() { ctest --test-dir "$build" --show-only=json-v1 -R '^scene\.limits$' | tr -d ' \n' | grep -o '"name":"TIMEOUT","value":[0-9]*' | sed 's/.*://'; }
for factor in '' 1 3 x; do
    [ "$factor" = 3 ] && wanted=180 || wanted=60
    got=$(AFTERGLOW_TEST_TIME_FACTOR=$factor limit)
    [ "$got" = "$wanted" ] || { echo "factor '$factor': a limit of $got s, not $wanted s"; bad=1; }
done

# A copy of ./check whose cmake does nothing, and whose ctest runs one small suite for each preset.
mkdir -p "$folder/tools" "$folder/bin"
cp "$source/check" "$folder"
cp "$source/tools/test_totals" "$folder/tools"
echo 'setup_packages() { :; }; say() { echo "$*"; }' >"$folder/tools/setup"
printf '#!/bin/sh\n[ "$2" != "$BROKEN_PRESET" ]\n' >"$folder/bin/cmake"
cat >"$folder/bin/ctest" <<STUB
#!/bin/sh
preset=\${2#build/}
mkdir -p "\$2"
echo "ran \$preset with factor \${AFTERGLOW_TEST_TIME_FACTOR:-none}: \$*"
cp "$folder/\$preset.tests" "\$2/CTestTestfile.cmake"
exec "$(command -v ctest)" --test-dir "\$2" --output-junit "$folder/build/check-\$preset.xml"
STUB
chmod +x "$folder/bin/cmake" "$folder/bin/ctest"
cat >"$folder/asan.tests" <<'SUITE'
add_test(plain true)
add_test(lost "/nowhere/program")
add_test(mixed sh "-c" "echo 'cases: 4 passed, 0 failed, 2 skipped (no sample: 2)'; exit 1")
add_test(killed sh "-c" "echo begins; kill -9 $$")
SUITE
cat >"$folder/tsan.tests" <<'SUITE'
add_test(cases sh "-c" "echo 'cases: 7 passed, 0 failed, 0 skipped'")
SUITE
cat >"$folder/debug.tests" <<'SUITE'
add_test(cases sh "-c" "echo 'cases: 20 passed, 0 failed, 3 skipped (no sample: 1, no thing: 2)'")
add_test(whole sh "-c" "echo 'skipped: no thing'; exit 77")
set_tests_properties(whole PROPERTIES SKIP_RETURN_CODE 77)
SUITE
# run BROKEN_PRESET [arguments of ./check]
run() { broken=$1; shift; (cd "$folder" && PATH="$folder/bin:$PATH" BROKEN_PRESET=$broken AFTERGLOW_TEST_TIME_FACTOR= ./check "$@" >out 2>&1 </dev/null); }

run none --all -R . && { echo "a failed suite is no failure"; bad=1; }
for preset in asan tsan debug; do grep -q "^ran $preset with factor [1-9]" "$folder/out" || { echo "$preset did not run"; bad=1; }; done
expect "after a failure" "failed suites: asan" "$folder/out"
expect "cases of all suites" "cases: 32 passed, 3 failed, 6 skipped (no sample: 3, no thing: 3)" "$folder/out"
expect "failed test" "	mixed (build/check-asan.xml)" "$folder/out"
expect "summary" "57% tests passed, 3 tests failed out of 7" "$folder/out"

echo 'add_test(plain true)' >"$folder/asan.tests"
run none -R . || { echo "passed suites are a failure"; bad=1; }
expect "passed suites" "100% tests passed, 0 tests failed out of 3" "$folder/out"
grep -q '^ran asan .*-LE ^slow\$' "$folder/out" || { echo "slow tests ran with sanitizers without --all"; bad=1; }
grep -q "^ran tsan" "$folder/out" && { echo "the thread sanitizer ran without --all"; bad=1; }

run none || { echo "./check fails"; bad=1; }
grep -q '^ran debug .*-LE ^thorough\$' "$folder/out" || { echo "thorough tests ran without --all"; bad=1; }
run none --all || { echo "./check --all fails"; bad=1; }
grep -q '^ran debug .*thorough' "$folder/out" && { echo "thorough tests did not run with --all"; bad=1; }

run debug -R . && { echo "a suite that is not built is no failure"; bad=1; }
expect "a broken build" "failed suites: debug" "$folder/out"
expect "without a suite" "cases: 1 passed, 1 failed, 0 skipped" "$folder/out"
expect "which suite" "	build/check-debug.xml: the suite did not run" "$folder/out"
exit $bad

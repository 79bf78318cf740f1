"""Print each benchmark also as a multiple of the yardstick measured in the same run."""

YARDSTICK = "test_yardstick_dgesv_of_200"


def pytest_terminal_summary(terminalreporter, config):
    session = getattr(config, "_benchmarksession", None)
    medians = {bench.name: bench.stats.median for bench in session.benchmarks} if session else {}
    if YARDSTICK not in medians:
        return
    terminalreporter.section("medians, in seconds and in yardsticks (one dgesv of n = 200)")
    for name, median in medians.items():
        terminalreporter.write_line(f"{name:55} {median:10.4f} s {median / medians[YARDSTICK]:10.0f}")

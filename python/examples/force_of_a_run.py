"""Force on a wall over time, for two frictions of the base: a figure from two runs.

    python force_of_a_run.py CASE.toml FIGURE.svg
"""

import sys

import checkdam
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def main(path: str, figure: str) -> None:
    fig, ax = plt.subplots(figsize=(7, 4), layout="constrained")
    for friction in (0.3, 0.4):
        case = checkdam.load(path)
        case["boundaries.base.friction"] = friction
        run = case.run()
        history = run.history
        doubt = "" if run.trusted else ", not to be trusted"
        line, = ax.plot(history["time_s"], history["force_normal_n"], label=f"friction of the base {friction}{doubt}")
        static = run.summary["barrier"]["static_force_n"]
        ax.axhline(static, color=line.get_color(), linestyle=":", linewidth=1)
        print(f"friction {friction}: {static:.1f} N at rest{doubt}", *run.reasons, sep="\n  ")
    ax.set(xlabel="time (s)", ylabel="normal force on the wall (N)", title="Dotted: force at rest")
    ax.legend()
    fig.savefig(figure, metadata={"Date": None})


if __name__ == "__main__":
    main(*sys.argv[1:])

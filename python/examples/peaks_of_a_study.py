"""Peak force against an angle, with the scatter of other packings: a figure from a study.

    python peaks_of_a_study.py STUDY.toml FIGURE.svg
"""

import sys

import checkdam
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def main(path: str, figure: str) -> None:
    study = checkdam.study(path)
    runs = study.to_pandas()
    peaks = runs.groupby("inclination_deg")["peak_20ms_n"].agg(["mean", "std", "count"])
    print(peaks)
    fig, ax = plt.subplots(figsize=(7, 4), layout="constrained")
    ax.plot(runs["inclination_deg"], runs["peak_20ms_n"], ".", color="0.6", label="runs")
    ax.errorbar(peaks.index, peaks["mean"], yerr=peaks["std"], fmt="o", capsize=4, label="mean and standard deviation")
    ax.set(xlabel="inclination (degrees)", ylabel="largest mean force over 20 ms (N)")
    ax.legend()
    fig.savefig(figure, metadata={"Date": None})


if __name__ == "__main__":
    main(*sys.argv[1:])

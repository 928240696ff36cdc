//! The pressure that runs up the flow from the barrier (Fig. 7), and how fast.

use super::releases::{BARRIERS, Release, WAVE_STEP, arrival, rows_of};
use crate::barrier::PUBLISHED;
use crate::{Failure, data};
use checkdam::output::Table;
use checkdam_verification::report::number;

/// Correlation below which distances and times do not make a wave.
const STRAIGHT: f64 = 0.85;
/// Of the frames, every so many are shown.
const SHOWN: usize = 8;

/// The frames that are shown, by how long after the arrival they are.
pub(super) fn shown(release: &Release, wave: &Table) -> Result<String, Failure> {
    let (time, distance, pressure) = (wave.column("time_s")?, wave.column("distance_m")?, wave.column("pressure_pa")?);
    let mut text = String::from("barrier,shown,distance_m,pressure_pa\n");
    for (barrier, _) in BARRIERS {
        let arrival = arrival(release, barrier)?.time;
        for k in rows_of(wave, barrier)? {
            // A frame is the first step at or after its time.
            let frame = ((time[k] - arrival) / WAVE_STEP).round() as usize;
            if frame.is_multiple_of(SHOWN) {
                let after = 1e3 * frame as f64 * WAVE_STEP;
                text += &format!("{barrier},{after:.0} ms,{},{}\n", number(distance[k]), number(pressure[k]));
            }
        }
    }
    Ok(text)
}

/// Header of the table of celerities.
pub(super) const CELERITIES: &str =
    "release,barrier,largest_pressure_pa,celerity_m_per_s,correlation,distances,farthest_m,paper_m_per_s\n";

/// How fast the wave runs up the flow: at each distance, when the pressure first reaches half of the largest next to the face; a straight
/// line through distance over time by least squares, and its correlation; no celerity where that is poor.
pub(super) fn celerities(release: &str, wave: &Table) -> Result<String, Failure> {
    let (time, distance, pressure) = (wave.column("time_s")?, wave.column("distance_m")?, wave.column("pressure_pa")?);
    let paper = |barrier: &str| match barrier {
        "steel" => number(data::row(PUBLISHED, "B28").value),
        "plastic" => number(data::row(PUBLISHED, "B29").value),
        _ => String::new(),
    };
    let mut text = String::new();
    for (barrier, _) in BARRIERS {
        let mut rows = rows_of(wave, barrier)?;
        rows.retain(|&k| distance[k] >= 0.0);
        let nearest = rows.iter().map(|&k| distance[k]).fold(f64::INFINITY, f64::min);
        let largest =
            rows.iter().filter(|&&k| distance[k] <= nearest + 0.011).map(|&k| pressure[k]).fold(0.0, f64::max);
        let mut places: Vec<f64> = rows.iter().map(|&k| distance[k]).collect();
        places.sort_by(f64::total_cmp);
        places.dedup();
        let reached: Vec<(f64, f64)> = places
            .iter()
            .filter_map(|&d| {
                let own = rows.iter().filter(|&&k| distance[k] == d && pressure[k] >= 0.5 * largest);
                own.map(|&k| time[k]).reduce(f64::min).map(|t| (t, d))
            })
            .collect();
        let (slope, correlation) = line(&reached);
        let slope = if correlation >= STRAIGHT { slope } else { f64::NAN };
        let farthest = reached.iter().map(|p| p.1).fold(0.0, f64::max);
        let numbers = [largest, slope, correlation].map(|x| if x.is_finite() { number(x) } else { String::new() });
        let (numbers, paper) = (numbers.join(","), paper(barrier));
        text += &format!("{release},{barrier},{numbers},{},{},{paper}\n", reached.len(), number(farthest));
    }
    Ok(text)
}

/// Slope of a straight line by least squares, and the correlation.
fn line(points: &[(f64, f64)]) -> (f64, f64) {
    let n = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let sum = |of: &dyn Fn(f64, f64) -> f64| points.iter().map(|p| of(p.0 - x, p.1 - y)).sum::<f64>();
    let (xx, yy, xy) = (sum(&|a, _| a * a), sum(&|_, b| b * b), sum(&|a, b| a * b));
    (xy / xx, xy / (xx * yy).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_front_that_moves_steadily_has_its_celerity() {
        let mut text = String::from("barrier,time_s,distance_m,pressure_pa\n");
        for step in 0..20 {
            for cell in 0..10 {
                let (t, d) = (0.002 * f64::from(step), 0.01 * f64::from(cell));
                let p = if d <= 2.5 * t { 1000.0 } else { 10.0 };
                text += &format!("steel,{t},{d},{p}\n");
            }
        }
        let table = Table::parse(&text, "wave.csv").expect("a table");
        let csv = celerities("literal", &table).expect("celerities");
        let row = csv.lines().find(|l| l.contains("steel")).expect("steel");
        assert_eq!(row.split(',').collect::<Vec<_>>()[..4], ["literal", "steel", "1000", "2.5"]);
    }
}

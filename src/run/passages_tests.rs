use super::*;
use crate::case;
use crate::gauge::Front;
use crate::scaffold::FLUME;

/// A flow at 2 m/s whose edge is 0.1 m ahead of its front, with a row each millisecond, on a slope of 40 degrees.
fn passed(x: f64) -> FrontPassage {
    let mut case = case::parse(FLUME, "flume.toml").unwrap_or_else(|e| panic!("{e}")).case;
    case.gauges.stations_m = vec![x];
    let row = |k: u32| {
        let time = 1e-3 * f64::from(k);
        let front = Front { x: 2.0 * time, edge: 2.0 * time + 0.1, velocity: 2.0, depth: 0.03 };
        HistoryRow { time, front, ..HistoryRow::default() }
    };
    let records = Records { history: (1..600).map(row).collect(), ..Records::default() };
    let scales = Scales {
        flow_direction_1: 1.0,
        front_length_m: 0.05,
        arrival_force_n: 0.5,
        flow_density_kg_per_m3: 1500.0,
        flow_wave_speed_m_per_s: 30.0,
        resolution_s: 1e-3,
    };
    at_stations(&case, &records, &scales).remove(0)
}

#[test]
fn edge_and_front_pass_a_station_each_at_its_time() {
    let found = passed(0.5005);
    assert!((found.time_s - 0.251).abs() < 1e-12, "{found:?}");
    assert!((found.edge_time_s - 0.201).abs() < 1e-12, "{found:?}");
    // Across the slope gravity is g cos(40 degrees).
    let froude = 2.0 / (9.81 * libm::cos(40f64.to_radians()) * 0.03).sqrt();
    assert!((found.froude_1 / froude - 1.0).abs() < 1e-12 && found.velocity_m_per_s == 2.0, "{found:?}");
}

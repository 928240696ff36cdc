//! Whether there is memory for a case, before it is asked for: an allocation that fails ends the process without a word.

use checkdam::case::Case;

/// What a material point takes while a scene is set up, with its share of the grid: 260 to 285 bytes were seen.
const BYTES_PER_POINT: f64 = 300.0;

/// What a case needs in bytes and what there is, if it is not enough.
pub fn missing(case: &Case) -> Option<String> {
    let needed = BYTES_PER_POINT * case.particle_count_estimate();
    let refused = Vec::<u8>::new().try_reserve_exact(needed as usize).is_err();
    let free = available().filter(|free| needed > *free);
    if !refused && free.is_none() {
        return None;
    }
    let there = free.map_or(String::new(), |free| format!(" and {:.1} GB are free", free / 1e9));
    Some(format!(
        "the case needs about {:.1} GB of memory{there}\n  = fix: use a larger grid.spacing_m: memory goes with 1/spacing_m^2",
        needed / 1e9
    ))
}

/// Memory that is free, in bytes, where the system says so.
fn available() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    Some(1024.0 * line.trim().trim_end_matches("kB").trim().parse::<f64>().ok()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_case_larger_than_the_machine_is_told() {
        let text = include_str!("../../validation/flume/40deg.toml");
        let mut case = checkdam::case::parse(text, "flume").expect("a case").case;
        assert_eq!(missing(&case), None);
        // 4e14 points: more than any machine holds.
        case.grid.spacing_m = 1.0e-8;
        let told = missing(&case).expect("too little memory");
        assert!(told.contains("needs about") && told.contains("fix: use a larger grid.spacing_m"), "{told}");
    }
}

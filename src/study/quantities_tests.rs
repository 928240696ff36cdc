use super::super::Row;
use super::super::tests::CASE;
use super::*;
use crate::{case, run};
use std::collections::BTreeMap;
use toml::Value;

/// A block of rubber that slides down a floor, on which it bounces a little.
fn summary() -> Summary {
    let sliding = [
        ("inclination_deg = 0", "inclination_deg = 30"),
        ("contact = \"smooth\"", "contact = \"coulomb\"\nfriction = 0.3"),
        ("end_time_s = 0.3", "end_time_s = 0.1\nstop_at_rest = false"),
        ("barrier = \"floor\"", "barrier = \"floor\"\nbase = \"floor\""),
    ];
    let text = sliding.iter().fold(CASE.to_string(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replacen(from, to, 1)
    });
    let case = case::parse(&text, "slide.toml").unwrap_or_else(|e| panic!("{e}")).case;
    run::run_in_memory(&case, &mut |_| true).unwrap_or_else(|e| panic!("{e}")).2
}

/// Numbers below a value, by their names; of the front, which is a list, none.
fn numbers(value: &Value, found: &mut BTreeMap<String, f64>) {
    for (name, value) in value.as_table().into_iter().flatten().filter(|(name, _)| *name != "case") {
        match value.as_float() {
            Some(number) => _ = found.insert(name.clone(), number),
            None => numbers(value, found),
        }
    }
}

#[test]
fn a_quantity_is_the_number_of_its_name_in_the_summary() {
    let summary = summary();
    let mut named = BTreeMap::new();
    numbers(&summary.to_toml().parse::<toml::Table>().map(Value::Table).expect("TOML"), &mut named);
    let mut seen = 0;
    for quantity in QUANTITIES {
        if let Some(number) = named.get(quantity.name) {
            assert_eq!((quantity.of)(&summary).to_bits(), number.to_bits(), "{}", quantity.name);
            seen += 1;
        }
    }
    assert!(seen > 25, "{seen} quantities");
    let told = named["static_shear_n"] / named["static_force_n"];
    assert!(told.abs() > 0.2, "a force and a shear that could be taken for each other: {told}");
}

#[test]
fn what_is_dissipated_is_what_all_agents_took() {
    let summary = summary();
    let e = &summary.energy;
    let taken = e.plastic_1 + e.friction_1 + e.impact_1 + e.pic_1 + e.side_walls_1 + e.outflow_1 + e.residual_end_1;
    let dissipated = QUANTITIES.iter().find(|q| q.name == "dissipated_1").map(|q| (q.of)(&summary));
    let dissipated = dissipated.expect("a quantity");
    assert!(e.elastic_1 > 1e-5 && e.friction_1 > 1e-3, "{e:?}");
    assert!((dissipated - taken).abs() < 1e-12, "{dissipated} {taken}");
}

#[test]
fn a_row_keeps_nine_digits() {
    let numbers = [1.234_567_894_9, -9.876_543_21e-7, 1.0 / 3.0];
    for (text, number) in Row::new("at rest", true, &numbers).values.iter().zip(numbers) {
        let kept: f64 = text.parse().expect("a number");
        assert!((kept / number - 1.0).abs() < 5e-9, "{text} of {number}");
    }
}

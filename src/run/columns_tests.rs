use super::super::table::Names;
use super::*;
use crate::gauge::Passage;

/// What a name ends in for a unit.
fn ending(unit: &str) -> Option<&'static str> {
    let all = [
        ("s", "_s"),
        ("m", "_m"),
        ("m/s", "_m_per_s"),
        ("N", "_n"),
        ("N m", "_n_m"),
        ("N s", "_n_s"),
        ("J", "_j"),
        ("kg", "_kg"),
        ("Pa", "_pa"),
        ("cells", "_cells"),
        ("1", ""),
        ("m2", "_m2"),
        ("-", ""),
    ];
    all.into_iter().find(|(u, _)| *u == unit).map(|(_, end)| end)
}

#[test]
fn every_column_has_a_meaning_and_ends_in_its_unit() {
    let tables = columns();
    let files: Vec<_> = tables.iter().map(|t| t.file).collect();
    assert!((1..files.len()).all(|k| !files[..k].contains(&files[k])), "{files:?}");
    for table in &tables {
        assert!(!table.row.is_empty() && !table.columns.is_empty(), "{table:?}");
        for (k, c) in table.columns.iter().enumerate() {
            assert!(!c.meaning.is_empty(), "{c:?}");
            assert!(table.columns[..k].iter().all(|other| other.name != c.name), "{c:?}");
            let end = ending(c.unit).unwrap_or_else(|| panic!("{c:?}: a unit that is not known"));
            assert!(c.name.ends_with(end), "{c:?}");
        }
    }
}

#[test]
fn columns_of_boundaries_and_surfaces_stand_once_for_each() {
    let names = Names {
        boundaries: vec!["bed".into(), "wall".into()],
        surfaces: vec!["bed".into(), "wall".into(), "sand_on_fence".into()],
        ..Names::default()
    };
    let header = ENERGY.header(&names);
    assert_eq!(header[5..8], ["friction_bed_j", "friction_wall_j", "friction_sand_on_fence_j"]);
    assert_eq!(header[8..11], ["contact_bed_j", "contact_wall_j", "contact_sand_on_fence_j"]);
    let balance = crate::ledger::EnergyBalance {
        friction: vec![1.0, 2.0, 3.0],
        contact: vec![4.0, 5.0, 6.0],
        residual: 7.0,
        ..Default::default()
    };
    let mut values = Vec::new();
    ENERGY.values(&names, &EnergyRow { time: 0.5, balance }, &mut values);
    assert_eq!(values, [0.5, 0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 0.0, 0.0, 0.0, 0.0, 7.0]);
    let header = MOMENTUM.header(&names);
    assert_eq!(header[5..9], ["bed_x_n_s", "bed_y_n_s", "wall_x_n_s", "wall_y_n_s"]);
}

#[test]
fn a_further_barrier_has_the_columns_of_its_forces() {
    let all = HISTORY.header(&Names::default());
    let own = FURTHER.header(&Names::default());
    assert!(own.iter().all(|name| all.contains(name)) && own.contains(&"run_up_m".to_string()), "{own:?}");
    let (mut values, mut of_all) = (Vec::new(), Vec::new());
    let passage = Passage { over: 6.0, under: 7.0, past: 8.0 };
    let row = HistoryRow { time: 1.0, normal: 2.0, layers: [3.0, 4.0, 5.0], passage, ..HistoryRow::default() };
    FURTHER.values(&Names::default(), &row, &mut values);
    HISTORY.values(&Names::default(), &row, &mut of_all);
    for (name, value) in own.iter().zip(&values) {
        let k = all.iter().position(|other| other == name).expect("a column");
        assert_eq!(of_all[k], *value, "{name}");
    }
}

/// Names that a boundary may not have are those of the other columns of the momentum table.
#[test]
fn no_boundary_is_called_like_another_agent() {
    let columns = MOMENTUM.header(&Names::default());
    let agents: Vec<&str> = columns.iter().filter_map(|name| name.strip_suffix("_x_n_s")).collect();
    assert_eq!(agents, crate::case::AGENTS);
}

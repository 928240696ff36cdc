use super::*;

/// Powers of two: every subset has another sum, so what is missing, doubled or of the wrong sign shows.
fn ledger() -> Ledger {
    let drag = |k: i32| Drag { impulse: [2f64.powi(k), -2f64.powi(k + 1)], work: -2f64.powi(k + 2) };
    let tally = |k: i32| Tally {
        impulse: [2f64.powi(k), -2f64.powi(k + 1)],
        moment: 9e9,
        friction_work: -2f64.powi(k + 2),
        normal_work: -2f64.powi(k + 3),
    };
    Ledger {
        gravity: [1.0, -2.0],
        boundaries: vec![tally(2), tally(6)],
        elastic_slip: vec![2f64.powi(36), 0.0],
        opening_slip: vec![0.0, 2f64.powi(37)],
        contacts: vec![],
        damping: drag(10),
        side_walls: drag(14),
        field: drag(18),
        internal_work: 2f64.powi(22),
        pic_loss: 2f64.powi(23),
        departed_momentum: [2f64.powi(24), -2f64.powi(25)],
        departed_energy: 2f64.powi(26),
        departed_mass: 9e9,
        entered_mass: 9e9,
        entered_heavy: 9e9,
        entered_momentum: [2f64.powi(38), -2f64.powi(39)],
        entered_energy: 2f64.powi(38),
        inflow_impulse: [2f64.powi(40), -2f64.powi(41)],
        inflow_work: 2f64.powi(39),
        impulse_scale: 9e9,
    }
}

#[test]
fn a_new_ledger_is_empty_and_has_a_line_for_each_boundary() {
    let ledger = Ledger::new(3, 2);
    assert_eq!(ledger.boundaries, [Tally::default(); 3]);
    assert_eq!(ledger.contacts, [ContactTally::default(); 2]);
    assert_eq!(ledger.impulse(), [0.0; 2]);
}

#[test]
fn impulse_is_what_all_agents_gave_less_what_left() {
    let p = |k: i32| 2f64.powi(k);
    let x = 1.0 + p(2) + p(6) + p(10) + p(14) + p(18) - p(24) + p(38) + p(40);
    assert_eq!(ledger().impulse(), [x, -2.0 * x]);
}

#[test]
fn energy_is_booked_once_each_with_dissipation_positive() {
    let p = |k: i32| 2f64.powi(k);
    let opening =
        Stock { mass: 9e9, heavy: 9e9, momentum: [9e9; 2], kinetic: p(30), gravitational: p(31), elastic: p(32) };
    let now = Stock { mass: 8e9, heavy: 8e9, momentum: [8e9; 2], kinetic: p(27), gravitational: p(28), elastic: p(29) };
    let b = EnergyBalance::new(&ledger(), &opening, &now, [p(33), p(34), p(35)]);
    assert_eq!(b.kinetic, p(27));
    assert_eq!(b.gravitational, p(28) - p(34));
    assert_eq!(b.elastic, p(29) + p(36));
    // Stress worked 2^22 J; what is stored less of it than before adds to what was dissipated.
    assert_eq!(b.plastic, p(22) + p(32) - p(29));
    // Work against friction that elastic slip stores is not lost, and what it gives back is.
    assert_eq!(b.friction, [p(4) - p(36), p(8) + p(37)]);
    assert_eq!(b.contact, [p(5), p(9)]);
    assert_eq!((b.damping, b.side_walls, b.field), (p(12), p(16), p(20)));
    assert_eq!(b.pic, p(23));
    // Mass that left took the energy of the datum level along, and mass that entered brought it.
    assert_eq!(b.outflow, p(26) + p(34) - p(33) - p(35));
    assert_eq!(b.inflow, p(38) - p(35) + p(39));
    assert_eq!(b.initial, p(30) + p(31) - p(33) + (p(32) + p(37)));
    let all =
        p(27) + (p(28) - p(34)) + p(29) + (p(22) + p(32) - p(29)) + p(4) + p(8) + p(37) + p(5) + p(9) + p(12) + p(16);
    let all = all + p(20) + p(23) + (p(26) + p(34) - p(33) - p(35));
    assert_eq!(b.accounted(), all);
    assert_eq!(b.residual, b.initial + b.inflow - all);
    assert_eq!(b.released(), b.initial + b.inflow - b.gravitational - b.outflow);
}

#[test]
fn contacts_of_bodies_dissipate_and_give_no_impulse() {
    let exchange = crate::contact::pair::Exchange { impulse: [3.0, 5.0], friction_work: -0.25, normal_work: -0.5 };
    let with = Ledger { contacts: vec![ContactTally { exchange, moment: 9e9, nodes: 3 }], ..ledger() };
    assert_eq!(with.impulse(), ledger().impulse());
    let (opening, now) = (Stock::default(), Stock::default());
    let (without, balance) =
        (EnergyBalance::new(&ledger(), &opening, &now, [0.0; 3]), EnergyBalance::new(&with, &opening, &now, [0.0; 3]));
    assert_eq!((balance.friction[2], balance.contact[2]), (0.25, 0.5));
    assert_eq!(balance.residual, without.residual - 0.75);
}

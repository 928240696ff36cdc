pub mod scenes;
#[cfg(test)]
mod explore {
    use super::scenes::*;
    use crate::contact::rule::*;
    use crate::simulation::*;
    use crate::theory::impact;
    use crate::verification::Fault;
    use crate::verification::scene::*;

    #[test]
    fn two_bars() {
        for (m2, l2) in [(Material::new(1e6, 0.0, 1000.0), 1.0), (Material::new(20e6, 0.0, 2400.0), 1.0)] {
            let m1 = Material::new(1e6, 0.0, 1000.0);
            let cells = 50;
            let h = 1.0 / cells as f64;
            let c1 = (m1.elastic.young / m1.density).sqrt();
            let c2 = (m2.elastic.young / m2.density).sqrt();
            let v = 0.01 * c1;
            let exact1 = impact::Bar { density: m1.density, speed: c1, length: 1.0, velocity: v };
            let exact2 = impact::Bar { density: m2.density, speed: c2, length: l2, velocity: 0.0 };
            let phases = impact::phases(&exact1, &exact2);
            let parting = phases.last().unwrap().time[1];
            println!("exact {:?}", phases);
            for (nn, normal) in NORMALS {
                for (gn, gap) in GAPS {
                    if matches!(gap, GapRule::Displacements) && normal != NormalRule::LargerBody {
                        continue;
                    }
                    for off in [0.37] {
                        let start = 0.0;
                        let a = Part::new(Brick::new([-1.0 + off * h, 0.13 * h], [cells, 2], h), m1).moving([v, 0.0]);
                        let b = Part::new(Brick::new([off * h + start * h, 0.13 * h], [cells, 2], h), m2);
                        let rule = ContactRule { bodies: [0, 1], friction: 0.0, normal, gap };
                        let mut sim = Simulation::new(several(vec![a, b], vec![rule], vec![], &Fault::NONE));
                        let area = 2.0 * h * THICKNESS;
                        let (mut j, mut held, mut last) = (0.0, 0.0, 0.0);
                        let mut mid = [0.0; 2];
                        let t0 = phases[0].time[1];
                        let (mut mismatch, mut err) = (0.0f64, None);
                        while sim.time() < 1.3 * parting {
                            if let Err(e) = sim.step() {
                                err = Some(e);
                                break;
                            }
                            let dt = sim.time_step().dt;
                            let p = sim.contact_tallies().next().unwrap().exchange.impulse;
                            j += p[0];
                            if p[0] > 0.0 {
                                held += dt;
                                last = sim.time();
                            }
                            if (0.2..0.8).contains(&(sim.time() / t0)) {
                                mid = [mid[0] + p[0], mid[1] + dt];
                            }
                            let total = sim.stock().momentum;
                            mismatch = mismatch.max((total[0] / (m1.density * area * v) - 1.0).abs());
                        }
                        let _ = held;
                        let m_a = of_body(&sim, 0);
                        let m_b = of_body(&sim, 1);
                        let e = sim.energy_balance(&sim.stock(), [0.0; 2]);
                        let ex = impact::exit_velocities(&exact1, &exact2);
                        println!(
                            "{nn:28} {gn:14} {off:.2} F {:.4} J {:.4} last {:.4} va {:.4} vb {:.4} loss {:.4} fr {:.1e} res {:.1e} mom {:.1e} {:?}",
                            mid[0] / mid[1] / (phases[0].pressure * area),
                            j / (impact::impulse(&phases) * area),
                            last / parting,
                            m_a.momentum[0] / m_a.mass / v - ex[0] / v,
                            m_b.momentum[0] / m_b.mass / v - ex[1] / v,
                            e.contact[0] / e.initial,
                            e.friction[0] / e.initial,
                            e.residual / e.initial,
                            mismatch,
                            err.map(|e| e.what)
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn block() {
        use crate::boundary::*;
        use nalgebra::Vector2;
        let base_m = Material::new(2e7, 0.3, 1500.0);
        let h = 0.05;
        for tilt in [0.0f64, 23.0] {
            for slope in [40.0f64, 23.0] {
                let mu = 0.4;
                for (nn, normal) in NORMALS {
                    for (gn, gap) in GAPS {
                        if tilt > 0.0 && !matches!(gap, GapRule::Extents | GapRule::Approach) {
                            continue;
                        }
                        for pic in [1.0, 0.0] {
                            let al = -tilt.to_radians();
                            let t = [al.cos(), al.sin()];
                            let n = [-t[1], t[0]];
                            let at = |a: f64, b: f64| [0.013 + a * t[0] + b * n[0], 0.007 + a * t[1] + b * n[1]];
                            let base =
                                Part::new(Brick { angle: al, ..Brick::new(at(-0.2, -4.0 * h), [24, 4], h) }, base_m);
                            let block = Part::new(Brick { angle: al, ..Brick::new(at(0.0, 0.0), [8, 4], h) }, base_m);
                            let rule = ContactRule { bodies: [0, 1], friction: f64::INFINITY, normal, gap };
                            let clamp = Boundary::plane("clamp", at(0.0, -3.0 * h).into(), n.into(), Friction::Bonded)
                                .only_for(&[0]);
                            let _ = Vector2::new(0.0, 0.0);
                            let mut scene = several(vec![base, block], vec![rule], vec![clamp], &Fault::NONE);
                            let g = 9.81;
                            let (s, c) = (slope.to_radians().sin(), slope.to_radians().cos());
                            scene.gravity = [g * (t[0] * s - n[0] * c), g * (t[1] * s - n[1] * c)];
                            scene.numerics.pic = PicShare::Fraction(0.02);
                            let mut sim = Simulation::new(scene);
                            sim.set_damping(800.0);
                            let mut err = run_until(&mut sim, 0.15).err().map(|e| format!("{e}"));
                            sim.set_damping(0.0);
                            // start anew from the settled points
                            let mut parts = [
                                Part::new(Brick { angle: al, ..Brick::new(at(-0.2, -4.0 * h), [24, 4], h) }, base_m),
                                Part::new(Brick { angle: al, ..Brick::new(at(0.0, 0.0), [8, 4], h) }, base_m),
                            ];
                            for (b, p) in sim.particles() {
                                parts[b].points[p.id as usize] = p;
                            }
                            let _ = pic;
                            sim.set_contact_friction(0, mu);
                            sim.set_pic(PicShare::Fraction(pic));
                            sim.open_ledger();
                            let centre = |sim: &Simulation| {
                                let (mut x, mut y, mut k) = (0.0, 0.0, 0.0);
                                for (b, p) in sim.particles() {
                                    if b == 1 {
                                        x += p.x[0] * t[0] + p.x[1] * t[1];
                                        y += p.x[0] * n[0] + p.x[1] * n[1];
                                        k += 1.0;
                                    }
                                }
                                [x / k, y / k]
                            };
                            let x0 = centre(&sim);
                            let t0 = sim.time();
                            let mut imp = [0.0; 2];
                            while sim.time() < t0 + 0.4 && err.is_none() {
                                if let Err(e) = sim.step() {
                                    err = Some(e.to_string());
                                    break;
                                }
                                let p = sim.contact_tallies().next().unwrap().exchange.impulse;
                                imp[0] += p[0] * t[0] + p[1] * t[1];
                                imp[1] += p[0] * n[0] + p[1] * n[1];
                            }
                            let dt = sim.time() - t0;
                            let a = g * (s - mu * c);
                            let x = centre(&sim);
                            let m = sim.stock_of(|b| b == 1).mass;
                            let e = sim.energy_balance(&sim.stock(), [0.0; 2]);
                            let scale = 0.5 * g * s * dt * dt;
                            println!(
                                "tilt {tilt:2} slope {slope:2} {nn:28} {gn:13} pic {pic}: x err {:+.4} N {:.4} T/muN {:.4} rise {:+.4} h  fr {:.4} nl {:.1e} res {:+.1e} {:?}",
                                (x[0] - x0[0] - 0.5 * a * dt * dt) / scale,
                                imp[1] / (m * g * c * dt),
                                -imp[0] / (mu * m * g * c * dt),
                                (x[1] - x0[1]) / h,
                                e.friction[1] / (mu * m * g * c * 0.5 * a * dt * dt),
                                e.contact[1] / (m * g * s * scale),
                                e.residual / (m * g * s * scale),
                                err.map(|e| e.chars().take(60).collect::<String>())
                            );
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn deposit() {
        use crate::boundary::*;
        use crate::constitutive::*;
        use crate::contact::outline::Outline;
        use crate::gauge::penetration;
        use nalgebra::Vector2;
        let h = 0.02;
        for young in [5e5, 5e7] {
            let wall_m = Material::new(young, 0.2, 1200.0);
            let slope = 40.0f64.to_radians();
            let mut rules: Vec<(String, Option<ContactRule>)> = vec![("shared".into(), None)];
            for (nn, normal) in NORMALS {
                for (gn, gap) in GAPS {
                    if matches!(gap, GapRule::Displacements) || matches!(normal, NormalRule::NearestFace(1)) {
                        continue;
                    }
                    rules.push((
                        format!("{nn}, {gn}"),
                        Some(ContactRule { bodies: [0, 1], friction: 0.4, normal, gap }),
                    ));
                }
            }
            for (name, rule) in rules {
                let wall = Part::new(Brick::new([0.6, -2.0 * h], [5, 17], h), wall_m);
                let sand_b = Brick::new([0.0, 0.0], [10, 10], h);
                let sand_m = Material::new(1e6, 0.3, 1530.0);
                let outline =
                    Outline::trace(&wall.points.iter().map(|p| (p.id, p.x)).collect::<Vec<_>>(), 0.5 * h, 0.0);
                let bed =
                    Boundary::plane("bed", Vector2::new(0.0, 0.0), Vector2::new(0.0, 1.0), Friction::Coulomb(0.4))
                        .only_for(&[1]);
                let back = Boundary::plane("back", Vector2::new(0.0, 0.0), Vector2::new(1.0, 0.0), Friction::Smooth)
                    .only_for(&[1]);
                let mut clamp =
                    Boundary::plane("clamp", Vector2::new(0.6, 0.0), Vector2::new(0.0, 1.0), Friction::Bonded)
                        .only_for(&[0]);
                if rule.is_none() {
                    clamp = Boundary::plane(
                        "clamp",
                        Vector2::new(0.6, 0.0),
                        Vector2::new(0.0, 1.0),
                        Friction::Coulomb(0.4),
                    );
                }
                let mut scene = several(
                    vec![wall, Part::new(sand_b, sand_m)],
                    rule.into_iter().collect(),
                    vec![bed, back, clamp],
                    &Fault::NONE,
                );
                scene.bodies[1].0.law = AnyLaw::DruckerPrager(DruckerPrager::new(
                    LinearElastic::new(1e6, 0.3),
                    Cone::TriaxialCompression,
                    31f64.to_radians(),
                    0.0,
                    0.0,
                    f64::INFINITY,
                    true,
                ));
                scene.gravity = [9.81 * slope.sin(), -9.81 * slope.cos()];
                scene.numerics.pic = PicShare::Fraction(5e-4);
                scene.domain = [[-0.5, 2.0], [-0.5, 2.0]];
                let mut sim = Simulation::new(scene);
                let start = std::time::Instant::now();
                let mut err = None;
                let mut deep = 0.0f64;
                let mut peak = 0.0f64;
                let mut worst = 0.0f64;
                let mut k = 0;
                let mut win = [0.0; 2];
                let mut stat = [0.0; 2];
                let mut clampf = 0.0f64;
                while sim.time() < 1.5 {
                    if let Err(e) = sim.step() {
                        err = Some(e.to_string().chars().take(70).collect::<String>());
                        break;
                    }
                    k += 1;
                    if k % 20 == 0 {
                        deep = deep.max(penetration::measure(&sim, 0, &outline, h).deepest);
                        let e = sim.energy_balance(&sim.stock(), [0.6, 0.0]);
                        worst = worst.max((e.residual / e.initial).abs());
                    }
                    let dt = sim.time_step().dt;
                    let f = sim.contact_tallies().next().map_or(0.0, |t| -t.exchange.impulse[0]);
                    win = [win[0] + f, win[1] + dt];
                    if sim.time() > 1.2 {
                        stat = [stat[0] + f, stat[1] + dt];
                        clampf += -sim.step_tallies()[2].impulse[0];
                    }
                    if win[1] > 0.02 {
                        peak = peak.max(win[0] / win[1]);
                        win = [0.0; 2];
                    }
                }
                let e = sim.energy_balance(&sim.stock(), [0.6, 0.0]);
                let pen = penetration::measure(&sim, 0, &outline, 0.5 * h);
                println!(
                    "E {young:.0e} {name:40} peak {peak:6.1} static {:6.1} clamp {:6.1} deep {:.2} h beyond {:.3} kg  kin {:.1e} plast {:.3} fr {:.3} {:.3} {:.3} imp {:.4} res {:+.4} worst {:.4} {:.1}us/step {:?}",
                    stat[0] / stat[1],
                    clampf / stat[1],
                    deep / h,
                    pen.mass_beyond,
                    e.kinetic / e.initial,
                    e.plastic / e.initial,
                    e.friction[0] / e.initial,
                    e.friction.get(3).unwrap_or(&0.0) / e.initial,
                    e.friction[2] / e.initial,
                    e.contact.get(3).unwrap_or(&0.0) / e.initial,
                    e.residual / e.initial,
                    worst,
                    start.elapsed().as_micros() as f64 / k as f64,
                    err
                );
            }
        }
    }

    #[test]
    fn stiff() {
        use crate::boundary::*;
        use crate::constitutive::*;
        use crate::contact::outline::Outline;
        use crate::gauge::penetration;
        use nalgebra::Vector2;
        let h = 0.02;
        for young in [5e7] {
            let wall_m = Material::new(young, 0.2, 1200.0);
            let slope = 40.0f64.to_radians();
            let mut rules: Vec<(String, Option<ContactRule>)> = vec![];
            for (nn, normal) in NORMALS {
                for (gn, gap) in GAPS {
                    if matches!(gap, GapRule::Displacements) || matches!(normal, NormalRule::NearestFace(1)) {
                        continue;
                    }
                    rules.push((
                        format!("{nn}, {gn}"),
                        Some(ContactRule { bodies: [0, 1], friction: 0.4, normal, gap }),
                    ));
                }
            }
            for (name, rule) in rules {
                let wall = Part::new(Brick::new([0.6, -2.0 * h], [5, 17], h), wall_m);
                let sand_b = Brick::new([0.0, 0.0], [10, 10], h);
                let sand_m = Material::new(1e6, 0.3, 1530.0);
                let outline =
                    Outline::trace(&wall.points.iter().map(|p| (p.id, p.x)).collect::<Vec<_>>(), 0.5 * h, 0.0);
                let bed =
                    Boundary::plane("bed", Vector2::new(0.0, 0.0), Vector2::new(0.0, 1.0), Friction::Coulomb(0.4))
                        .only_for(&[1]);
                let back = Boundary::plane("back", Vector2::new(0.0, 0.0), Vector2::new(1.0, 0.0), Friction::Smooth)
                    .only_for(&[1]);
                let mut clamp =
                    Boundary::plane("clamp", Vector2::new(0.6, 0.0), Vector2::new(0.0, 1.0), Friction::Bonded)
                        .only_for(&[0]);
                if rule.is_none() {
                    clamp = Boundary::plane(
                        "clamp",
                        Vector2::new(0.6, 0.0),
                        Vector2::new(0.0, 1.0),
                        Friction::Coulomb(0.4),
                    );
                }
                let mut scene = several(
                    vec![wall, Part::new(sand_b, sand_m)],
                    rule.into_iter().collect(),
                    vec![bed, back, clamp],
                    &Fault::NONE,
                );
                scene.bodies[1].0.law = AnyLaw::DruckerPrager(DruckerPrager::new(
                    LinearElastic::new(1e6, 0.3),
                    Cone::TriaxialCompression,
                    31f64.to_radians(),
                    0.0,
                    0.0,
                    f64::INFINITY,
                    true,
                ));
                scene.gravity = [9.81 * slope.sin(), -9.81 * slope.cos()];
                scene.numerics.pic = PicShare::Fraction(5e-4);
                scene.domain = [[-0.5, 2.0], [-0.5, 2.0]];
                let mut sim = Simulation::new(scene);
                let start = std::time::Instant::now();
                let mut err = None;
                let mut deep = 0.0f64;
                let mut peak = 0.0f64;
                let mut worst = 0.0f64;
                let mut k = 0;
                let mut win = [0.0; 2];
                let mut stat = [0.0; 2];
                let mut clampf = 0.0f64;
                while sim.time() < 0.37 {
                    if let Err(e) = sim.step() {
                        err = Some(e.to_string());
                        break;
                    }
                    k += 1;
                    if sim.time() > 0.30 && k % 20 == 0 && k < 9700 {
                        let s = sim.stock_of(|b| b == 0);
                        let q = sim.stock_of(|b| b == 1);
                        let big = sim
                            .contact_points()
                            .iter()
                            .map(|p| (p.impulse[0].abs() + p.impulse[1].abs(), p.x, p.normal, p.impulse))
                            .max_by(|a, b| a.0.total_cmp(&b.0));
                        let fast = sim
                            .particles()
                            .filter(|(b, _)| *b == 0)
                            .max_by(|a, b| a.1.speed().total_cmp(&b.1.speed()))
                            .unwrap()
                            .1;
                        println!(
                            "{} t {:.5} K {:.3e} E {:.3e} sand K {:.3e} n {} big {:?} fast {:.3} at {:?}",
                            k,
                            sim.time(),
                            s.kinetic,
                            s.elastic,
                            q.kinetic,
                            sim.contact_points().len(),
                            big,
                            fast.speed(),
                            fast.x
                        );
                    }
                    if k % 20 == 0 {
                        deep = deep.max(penetration::measure(&sim, 0, &outline, h).deepest);
                        let e = sim.energy_balance(&sim.stock(), [0.6, 0.0]);
                        worst = worst.max((e.residual / e.initial).abs());
                    }
                    let dt = sim.time_step().dt;
                    let f = sim.contact_tallies().next().map_or(0.0, |t| -t.exchange.impulse[0]);
                    win = [win[0] + f, win[1] + dt];
                    if sim.time() > 1.2 {
                        stat = [stat[0] + f, stat[1] + dt];
                        clampf += -sim.step_tallies()[2].impulse[0];
                    }
                    if win[1] > 0.02 {
                        peak = peak.max(win[0] / win[1]);
                        win = [0.0; 2];
                    }
                }
                let e = sim.energy_balance(&sim.stock(), [0.6, 0.0]);
                let pen = penetration::measure(&sim, 0, &outline, 0.5 * h);
                println!(
                    "E {young:.0e} {name:40} peak {peak:6.1} static {:6.1} clamp {:6.1} deep {:.2} h beyond {:.3} kg  kin {:.1e} plast {:.3} fr {:.3} {:.3} {:.3} imp {:.4} res {:+.4} worst {:.4} {:.1}us/step {:?}",
                    stat[0] / stat[1],
                    clampf / stat[1],
                    deep / h,
                    pen.mass_beyond,
                    e.kinetic / e.initial,
                    e.plastic / e.initial,
                    e.friction[0] / e.initial,
                    e.friction.get(3).unwrap_or(&0.0) / e.initial,
                    e.friction[2] / e.initial,
                    e.contact.get(3).unwrap_or(&0.0) / e.initial,
                    e.residual / e.initial,
                    worst,
                    start.elapsed().as_micros() as f64 / k as f64,
                    err
                );
            }
        }
    }
}

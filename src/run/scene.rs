//! From a validated case to a scene.
//!
//! What is chosen by a word alone needs no translation here: the case has the solver's enum. Where a word has numbers beside it, the case
//! has words of its own, and makes the solver's type of both; the head of `case/boundary.rs` says why. Here is what needs the rest of the
//! case besides: the law of a material, the shape of a boundary on its grid, bodies by their names.

use super::filling;
use crate::body::{Body, Particle};
use crate::boundary::{Boundary, Friction};
use crate::case::{self, Case};
use crate::constitutive::{AnyLaw, DruckerPrager, LinearElastic, MohrCoulomb, MuI, NeoHookean, Softening, VonMises};
use crate::contact::rule::ContactRule;
use crate::grid::Lattice;
use crate::mesh::Mesh;
use crate::seeded::{self, Seed};
use crate::simulation::{Numerics, PicShare, Scene};
use nalgebra::Vector2;

/// Builds the scene of a case that has passed validation, with gravity as it is while the material settles.
pub fn build(case: &Case) -> Scene {
    let angle = case.gravity.settle_inclination_or_default_deg();
    Scene {
        lattice: Lattice { spacing: case.grid.spacing_m, origin: case.grid.origin_m },
        thickness: seeded::times(Seed::CaseThickness, case.grid.thickness_m),
        domain: [case.domain.x_m, case.domain.y_m],
        bodies: case.bodies.iter().map(|b| body(case, b)).collect(),
        boundaries: case.boundaries.iter().filter_map(|b| boundary(case, b)).collect(),
        gravity: gravity(case, angle),
        contacts: case.contacts.iter().filter_map(|c| contact(case, c)).collect(),
        side_wall_friction: if seeded::is(Seed::CaseSideWalls) { 0.0 } else { case.side_walls.friction },
        numerics: numerics(case),
    }
}

/// Gravity in the frame of the flume inclined by `angle_deg`, m/s2.
pub fn gravity(case: &Case, angle_deg: f64) -> [f64; 2] {
    let g = seeded::times(Seed::CaseGravity, case.gravity.magnitude_m_per_s2);
    let angle = seeded::times(Seed::CaseInclination, angle_deg).to_radians();
    [g * libm::sin(angle), -g * libm::cos(angle)]
}

pub(super) fn body(case: &Case, b: &case::Body) -> (Body, Vec<Particle>) {
    let material = &case.materials[&b.material];
    let Filled { places, volume, spacing } = filled(case, b);
    let centre = b.drawing().map_or([0.0; 2], |d| d.centroid_m());
    let particle = |(id, x): (usize, [f64; 2])| {
        let v = b.velocity_at(x, centre).map(|v| seeded::times(Seed::CaseVelocity, v));
        Particle { v, ..Particle::at_rest(id as u32, x) }
    };
    let particles = places.into_iter().enumerate().map(particle).collect();
    let body = Body {
        name: b.name.clone(),
        law: law(material),
        point_mass: seeded::times(Seed::CaseDensity, material.density_kg_per_m3) * volume,
        point_volume: volume,
        points_per_direction: f64::from(b.particles_per_cell(&case.grid)).sqrt().round() as usize,
        point_spacing: spacing,
        weightless: b.weightless && !seeded::is(Seed::CaseWeightless),
        between_side_walls: case.side_walls.act_on(&b.name),
        implicit: b.integration == case::Integration::Implicit,
        mesh: (b.kinematics == case::Kinematics::TotalLagrangian).then(|| mesh(case, b)).flatten(),
    };
    (body, particles)
}

/// The particles of a body at the start.
struct Filled {
    /// Places, m.
    places: Vec<[f64; 2]>,
    /// Volume of one, m3.
    volume: f64,
    /// Their distance: the side of a square of the same area, m.
    spacing: f64,
}

fn filled(case: &Case, b: &case::Body) -> Filled {
    let moved = |id: u32| {
        let share = |axis: u64| b.jitter * (2.0 * uniform(u64::from(b.jitter_seed), 2 * u64::from(id) + axis) - 1.0);
        [share(0), share(1)]
    };
    let pieces = |area: f64, places: Vec<[f64; 2]>| {
        let own = area / places.len() as f64;
        Filled { volume: own * case.grid.thickness_m, spacing: own.sqrt(), places }
    };
    let count = || b.particle_count(&case.grid) as usize;
    match b.drawing() {
        Some(case::Drawing::Polygon(p)) => pieces(b.area_m2(), filling::polygon(&p, count(), b.rotation_deg, &moved)),
        Some(case::Drawing::Ring(r)) => pieces(b.area_m2(), filling::ring(&r, count(), b.rotation_deg, &moved)),
        Some(case::Drawing::Rectangle(r)) => lattice(case, b, &r, moved),
        None => Filled { places: Vec::new(), volume: 0.0, spacing: 0.0 },
    }
}

/// The lattice in a rectangle.
fn lattice(case: &Case, b: &case::Body, r: &case::Rectangle, moved: impl Fn(u32) -> [f64; 2]) -> Filled {
    let case::Lattice { counts: [nx, ny], spacing_m: [along, across] } = b.lattice(&case.grid);
    let (sin, cos) = (libm::sin(r.rotation_deg.to_radians()), libm::cos(r.rotation_deg.to_radians()));
    let mut places = Vec::with_capacity((nx * ny) as usize);
    for i in 0..nx as usize {
        for j in 0..ny as usize {
            let [right, up] = moved(places.len() as u32);
            let middle = if seeded::is(Seed::CasePlace) { 0.6 } else { 0.5 };
            let (u, v) = ((i as f64 + 0.5 + right) * along, (j as f64 + middle + up) * across);
            places.push([r.corner_m[0] + cos * u - sin * v, r.corner_m[1] + sin * u + cos * v]);
        }
    }
    let volume = along * across * case.grid.thickness_m;
    // Exact where the spacing fills both sides.
    Filled { places, volume, spacing: if along == across { along } else { (along * across).sqrt() } }
}

/// The reference configuration of a body, with edges of elements at its clamps; `None` of one that is no rectangle.
fn mesh(case: &Case, b: &case::Body) -> Option<Mesh> {
    let case::Rectangle { corner_m: corner, size_m, rotation_deg } = b.rectangle()?;
    let axes = [0.0, 90.0].map(|more| direction(rotation_deg + more));
    let mut cuts = [Vec::new(), Vec::new()];
    for boundary in case.boundaries.iter().filter(|o| o.acts_on(&b.name) && o.contact == case::ContactKind::Bonded) {
        let Some(case::Shape::Plane { point_m, normal_deg }) = boundary.shape(&case.grid) else { continue };
        let n = direction(normal_deg);
        // Planes lie along one of the edges; the other axis crosses them.
        let d = usize::from(axes[1].dot(&n).abs() > axes[0].dot(&n).abs());
        cuts[d].push((Vector2::from(point_m) - Vector2::from(corner)).dot(&axes[d]));
    }
    Some(Mesh::rectangle(corner, rotation_deg.to_radians(), size_m, case.grid.spacing_m, [&cuts[0], &cuts[1]]))
}

/// A number of \[0, 1\) from a seed and a counter: the same on every machine (SplitMix64; Steele, Lea and Flood 2014).
fn uniform(seed: u64, counter: u64) -> f64 {
    let mut z = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(counter).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

pub(super) fn law(material: &case::Material) -> AnyLaw {
    let young = seeded::times(Seed::CaseYoung, material.young_pa);
    let poisson = seeded::times(Seed::CasePoisson, material.poisson);
    let elastic = LinearElastic::new(young, poisson);
    match material.law {
        case::Law::LinearElastic => AnyLaw::LinearElastic(elastic),
        case::Law::NeoHookean => AnyLaw::NeoHookean(NeoHookean::new(young, poisson)),
        case::Law::DruckerPrager | case::Law::MohrCoulomb => material
            .frictional()
            .map_or(AnyLaw::LinearElastic(elastic), |given| frictional(material.law, &given, elastic)),
        case::Law::VonMises => AnyLaw::VonMises(VonMises {
            elastic,
            strength: seeded::times(Seed::CaseStrength, given(material.shear_strength_pa)),
            hardening: seeded::times(Seed::CaseHardening, given(material.hardening_pa)),
            viscosity: seeded::times(Seed::CaseViscosity, given(material.viscosity_pa_s)),
        }),
        case::Law::MuI => AnyLaw::MuI(MuI::new(
            elastic,
            [material.mu_s, material.mu_2].map(given),
            given(material.i_0),
            seeded::times(Seed::CaseGrains, given(material.grain_diameter_m)),
            given(material.grain_density_kg_per_m3),
            material.void_tracking.unwrap_or(true),
        )),
    }
}

/// A number that a validated case has where its law needs it; what has no number is zero.
fn given(number: Option<f64>) -> f64 {
    number.unwrap_or(0.0)
}

/// A law with a friction angle.
fn frictional(law: case::Law, given: &case::Frictional, elastic: LinearElastic) -> AnyLaw {
    let phi = seeded::times(Seed::CaseFrictionAngle, given.friction_angle_deg).to_radians();
    let psi = if seeded::is(Seed::CaseDilatancy) { 0.0 } else { given.dilatancy_angle_deg.to_radians() };
    let cohesion = seeded::times(Seed::CaseCohesion, given.cohesion_pa);
    let (cutoff, tracking) = (given.tension_cutoff_pa, given.void_tracking && !seeded::is(Seed::CaseVoids));
    let softening = given.softening.filter(|_| !seeded::is(Seed::CaseSoftening));
    let effective = 1.0 - seeded::times(Seed::CasePorePressure, given.pore_pressure_ratio);
    let cone = |phi, psi, cohesion| {
        let dry = DruckerPrager::new(elastic, given.cone, phi, psi, cohesion, cutoff, tracking);
        DruckerPrager { friction: effective * dry.friction, ..dry }
    };
    let pyramid = |phi, psi, cohesion| MohrCoulomb::new(elastic, phi, psi, cohesion, cutoff, tracking);
    match (law, softening) {
        (case::Law::MohrCoulomb, None) => AnyLaw::MohrCoulomb(pyramid(phi, psi, cohesion)),
        (case::Law::MohrCoulomb, Some([critical, over])) => {
            let critical = pyramid(critical.to_radians(), 0.0, 0.0).friction;
            AnyLaw::SofteningMohrCoulomb(Softening { peak: pyramid(phi, psi, cohesion), critical, over })
        }
        (_, None) => AnyLaw::DruckerPrager(cone(phi, psi, cohesion)),
        (_, Some([critical, over])) => {
            let critical = cone(critical.to_radians(), 0.0, 0.0).friction;
            AnyLaw::SofteningDruckerPrager(Softening { peak: cone(phi, psi, cohesion), critical, over })
        }
    }
}

/// Where the face of a body that is a barrier stands at the start, as a wall that nothing touches: on the side of the bodies with
/// which it is in contact, from where its highest clamp holds it (else from its lower edge) along its own y axis.
pub fn barrier_face(case: &Case, name: &str) -> Option<Boundary> {
    let body = case.bodies.iter().find(|b| b.name == name)?;
    let case::Rectangle { corner_m, size_m: [length, height], rotation_deg } = body.rectangle()?;
    let (across, up) = (direction(rotation_deg), direction(rotation_deg + 90.0));
    let centre = |b: &case::Body| match b.drawing() {
        Some(case::Drawing::Rectangle(r)) => r.corners_m().map(Vector2::from).iter().sum::<Vector2<f64>>() / 4.0,
        other => Vector2::from(other.map_or([0.0; 2], |d| d.centroid_m())),
    };
    let partner = |b: &&case::Body| {
        b.name != name
            && !case.gauges.barrier_names().any(|other| other == b.name)
            && case.contacts.iter().any(|c| c.bodies.contains(&b.name) && c.bodies.iter().any(|n| n == name))
    };
    let beside: f64 = case.bodies.iter().filter(partner).map(|b| (centre(b) - centre(body)).dot(&across)).sum();
    let corner = Vector2::from(corner_m) + across * if beside > 0.0 { length } else { 0.0 };
    let clamps = case.boundaries.iter().filter(|b| b.acts_on(name) && b.contact == case::ContactKind::Bonded);
    let held = clamps.filter_map(|b| {
        let case::Shape::Plane { point_m, normal_deg } = b.shape(&case.grid)? else { return None };
        let n = direction(normal_deg);
        Some((Vector2::from(point_m) - corner).dot(&n) / up.dot(&n))
    });
    let foot = held.filter(|s| (0.0..height).contains(s)).fold(0.0, f64::max);
    let wall = Boundary::wall(name, corner + up * foot, up, height - foot, length, Friction::Smooth);
    Some(if beside > 0.0 { wall.facing_right() } else { wall })
}

/// `None` only for a boundary that validation refuses.
fn boundary(case: &Case, b: &case::Boundary) -> Option<Boundary> {
    let friction = b.contact_law()?;
    let wall = |mut w: case::Wall| {
        if seeded::is(Seed::CaseFoot) {
            w.foot_m[0] += 0.1 * case.grid.spacing_m;
        }
        let wall =
            Boundary::wall(&b.name, w.foot_m.into(), direction(w.inclination_deg), w.height_m, w.thickness_m, friction);
        match w.material_side {
            case::MaterialSide::Left => wall,
            case::MaterialSide::Right => wall.facing_right(),
        }
    };
    let named = b.bodies.iter().flatten().filter_map(|name| index(case, name)).collect::<Vec<_>>();
    let boundary = match b.shape(&case.grid)? {
        case::Shape::Plane { point_m, normal_deg } => {
            Boundary::plane(&b.name, point_m.into(), direction(normal_deg), friction)
        }
        case::Shape::Wall(w) => wall(w),
        case::Shape::Gate(w, opening) => wall(w).gate(opening),
        case::Shape::Terrain(chain) => Boundary::terrain(&b.name, chain),
    };
    let boundary = match b.slip() {
        Some([length, peak]) => boundary.mobilised(seeded::times(Seed::CaseSlipLength, length), peak),
        None => boundary,
    };
    Some(boundary.only_for(&named))
}

/// `None` only for a contact that validation refuses.
fn contact(case: &Case, c: &case::BodyContact) -> Option<ContactRule> {
    let bodies = [index(case, c.bodies.first()?)?, index(case, c.bodies.get(1)?)?];
    let friction = seeded::times(Seed::CaseContactFriction, c.friction);
    Some(ContactRule { bodies, friction, normal: c.normal_rule()?, gap: c.gap_rule() })
}

/// Index of the body of this name.
pub fn index(case: &Case, name: &str) -> Option<usize> {
    case.bodies.iter().position(|b| b.name == name)
}

/// Unit vector at an angle from the x axis; exact along the axes, where walls may pass through nodes.
fn direction(angle_deg: f64) -> Vector2<f64> {
    case::direction(angle_deg).into()
}

fn numerics(case: &Case) -> Numerics {
    let n = &case.numerics;
    Numerics {
        scheme: n.scheme,
        shape: case.grid.shape_function,
        cfl: n.cfl,
        max_time_step: n.max_time_step_s.unwrap_or(f64::INFINITY),
        pic: if seeded::is(Seed::CasePic) { PicShare::Fraction(0.0) } else { n.pic() },
        boundary_contact: n.boundary_contact,
        opened_volume: n.opened_volume,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scaffold::{BARRIER, FLUME};

    #[test]
    fn a_body_may_have_more_particles_a_cell_than_the_grid_says() {
        let finer = BARRIER.replacen("name = \"barrier\"", "name = \"barrier\"\nparticles_per_cell = 16", 1);
        let cases = [BARRIER, &finer].map(|t| case::parse(t, "barrier.toml").expect("a case").case);
        let counts =
            cases.each_ref().map(|c| build(c).bodies.into_iter().map(|b| (b.1.len(), b.0)).collect::<Vec<_>>());
        let [(sand, _), (barrier, of_grid)] = &counts[0][..] else { panic!("two bodies") };
        let [(same, _), (more, of_body)] = &counts[1][..] else { panic!("two bodies") };
        // 0.2 m x 0.5 m and 0.1 m x 0.64 m in cells of 10 mm.
        assert_eq!((sand, same, barrier, more), (&9000, &9000, &5760, &10240));
        assert_eq!((of_grid.points_per_direction, of_body.points_per_direction), (3, 4));
        let mass = |n: usize, b: &Body| n as f64 * b.point_mass;
        assert!((mass(*more, of_body) / mass(*barrier, of_grid) - 1.0).abs() < 1e-12);
        assert_eq!(cases[1].particle_count_estimate(), 19240.0);
    }

    /// The apex of a cone matched to Mohr-Coulomb is that of Mohr-Coulomb: c cot(phi).
    #[test]
    fn cohesion_of_the_case_is_the_strength_of_the_material() {
        let text = FLUME.replacen("cohesion_pa = 0\n", "cohesion_pa = 500\n", 1);
        let text = text.replacen("tension_cutoff_pa = 0\n", "tension_cutoff_pa = 1.0e6\n", 1);
        let case = case::parse(&text, "flume.toml").unwrap_or_else(|e| panic!("{e}")).case;
        let AnyLaw::DruckerPrager(law) = build(&case).bodies[0].0.law else { panic!("another law") };
        let apex = 500.0 / libm::tan(31f64.to_radians());
        assert!((law.tension_cutoff / apex - 1.0).abs() < 1e-12, "{law:?} {apex}");
        assert!((law.cohesion / law.friction / apex - 1.0).abs() < 1e-12, "{law:?} {apex}");
    }

    /// The law of a case of one material with these keys.
    fn law_of(keys: &str) -> AnyLaw {
        let material: case::Material =
            toml::from_str(&format!("density_kg_per_m3 = 1500\nyoung_pa = 1e6\npoisson = 0.3\n{keys}"))
                .expect("a material");
        law(&material)
    }

    #[test]
    fn the_numbers_of_a_law_arrive_in_it() {
        let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-12, "{a} {b}");
        let mohr = "law = \"mohr_coulomb\"\nfriction_angle_deg = 35\ndilatancy_angle_deg = 8\ncohesion_pa = 500";
        let [sin, cos] = [libm::sin, libm::cos].map(|f| f(35f64.to_radians()));
        let AnyLaw::MohrCoulomb(law) = law_of(mohr) else { panic!("another law") };
        near(law.friction, sin);
        near(law.dilatancy, libm::sin(8f64.to_radians()));
        near(law.cohesion, 500.0 * cos);
        assert!(law.void_tracking && law.tension_cutoff == 0.0);
        let softens = "critical_friction_angle_deg = 30\nsoftening_strain = 0.2";
        let softening = law_of(&format!("{mohr}\n{softens}"));
        assert!(matches!(softening, AnyLaw::SofteningMohrCoulomb(_)));
        let AnyLaw::SofteningMohrCoulomb(law) = softening else { panic!("another law") };
        near(law.peak.friction, sin);
        near(law.critical, 0.5);
        near(law.over, 0.2);
        let cone = "law = \"drucker_prager\"\nfriction_angle_deg = 35\ndilatancy_angle_deg = 8";
        let AnyLaw::SofteningDruckerPrager(law) = law_of(&format!("{cone}\n{softens}")) else { panic!("another law") };
        assert!(AnyLaw::DruckerPrager(law.peak) == law_of(cone));
        near(law.critical, 0.5);
        let AnyLaw::DruckerPrager(dry) = law_of(cone) else { panic!("another law") };
        let AnyLaw::DruckerPrager(wet) = law_of(&format!("{cone}\npore_pressure_ratio = 0.4")) else {
            panic!("another law")
        };
        near(wet.friction, 0.6 * dry.friction);
        assert!(DruckerPrager { friction: dry.friction, ..wet } == dry);
        let clay = "law = \"von_mises\"\nshear_strength_pa = 2000\nhardening_pa = 3e4\nviscosity_pa_s = 20";
        let AnyLaw::VonMises(law) = law_of(clay) else { panic!("another law") };
        near(law.strength, 2000.0);
        near(law.hardening, 3e4);
        near(law.viscosity, 20.0);
        let beads = "law = \"mu_i\"\nmu_s = 0.38\nmu_2 = 0.64\ni_0 = 0.3\ngrain_diameter_m = 5e-4\ngrain_density_kg_per_m3 = 2500";
        let AnyLaw::MuI(law) = law_of(beads) else { panic!("another law") };
        assert_eq!([law.least, law.most], [0.38, 0.64]);
        // I_0 / (d sqrt(rho_s)) = 0.3 / (5e-4 x 50).
        near(law.half_way, 12.0);
        assert!(law.void_tracking);
    }

    #[test]
    fn a_raised_gate_stays_at_its_opening_after_its_way_at_its_speed() {
        let (gate, raised) = ("kind = \"gate\"\n", "kind = \"gate\"\nlift_speed_m_per_s = 0.8\nopening_m = 0.12\n");
        let mut text = FLUME.replacen(gate, raised, 1);
        let opening = text.find("opening = \"").map(|at| text[at..].lines().next().unwrap_or_default().to_string());
        let opening = opening.expect("how the gate opens");
        text = text.replacen(&opening, "opening = \"raise\"", 1);
        let case = case::parse(&text, "flume.toml").unwrap_or_else(|e| panic!("{e}")).case;
        let mut gate = build(&case).boundaries.into_iter().find(|b| b.name == "gate").expect("a gate");
        gate.release();
        let free = [0.1, 0.04, 0.02, 1.0].map(|dt| {
            gate.advance(dt);
            gate.free_below
        });
        let near = free.iter().zip([0.08, 0.112, 0.12, 0.12]).all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(near && !gate.is_opening() && !gate.is_gone(), "{free:?}");
    }

    /// A barrier behind another one, which it touches, faces the flow all the same.
    #[test]
    fn the_face_of_a_barrier_is_on_the_side_of_what_flows() {
        let mut case = case::parse(BARRIER, "barrier.toml").expect("a case").case;
        let before = barrier_face(&case, "barrier").expect("a face").normal;
        let (mut second, mut contact) = (case.bodies[1].clone(), case.contacts[0].clone());
        second.name = "second".into();
        let [c, s] = direction(second.rotation_deg).into();
        // Far to its right: as if it were what presses on the barrier's back.
        second.x_m = second.x_m.map(|x| x.map(|x| x + 3.0 * c));
        second.y_m = second.y_m.map(|y| y.map(|y| y + 3.0 * s));
        contact.bodies = vec!["barrier".into(), "second".into()];
        case.bodies.push(second);
        case.contacts.push(contact);
        let turned = barrier_face(&case, "barrier").expect("a face").normal;
        case.gauges.barriers = vec!["second".into()];
        assert_eq!(barrier_face(&case, "barrier").expect("a face").normal, before);
        assert_ne!(turned, before, "a body that is no barrier counts");
    }

    /// The recorded runs of the rigid barrier at 60 degrees on 20 mm have half a row of points too many.
    #[test]
    fn a_square_lattice_is_that_of_the_cells() {
        let text = FLUME.replacen("spacing_m = 0.01\n", "spacing_m = 0.02\n", 1);
        let text = text.replacen("x_m = [-0.2, 0.0]\ny_m = [0.0, 0.5]", "x_m = [-0.4, 0.0]\ny_m = [0.0, 0.25]", 1);
        let text = text.replacen("foot_m = [-0.2, 0.0]", "foot_m = [-0.4, 0.0]", 1);
        let text = text.replace("boundary_contact = \"nodes\"", "boundary_contact = \"surface\"");
        let text = text.replacen("particles_per_cell = 4", "particles_per_cell = 9", 1);
        let square = text.replacen("[grid]", "[grid]\nfilling = \"square\"", 1);
        let mass = |text: &str| {
            let loaded = case::parse(text, "flume.toml").unwrap_or_else(|e| panic!("{e}"));
            let scene = build(&loaded.case);
            (scene.bodies[0].1.len() as f64 * scene.bodies[0].0.point_mass, loaded.warnings.join(""))
        };
        let [(fitted, none), (more, warned)] = [mass(&text), mass(&square)];
        assert!((fitted - 30.0).abs() < 1e-9 && !none.contains("times its mass"), "{fitted} {none}");
        assert!(
            (more - 30.0 * 38.0 / 37.5).abs() < 1e-9 && warned.contains("carry 1.01333 times its mass"),
            "{more} {warned}"
        );
    }

    /// Whatever the cells: the points carry the mass of the drawing, and their own share of it ends where the drawing ends.
    #[test]
    fn points_carry_the_mass_of_the_drawing_and_end_where_it_ends() {
        for (h, per_cell, counts) in [
            ("0.01", 4, [40, 100]),
            ("0.03", 4, [13, 33]),
            ("0.016", 4, [25, 63]),
            ("0.07", 4, [6, 14]),
            ("0.0133333", 4, [30, 75]),
            ("0.04", 9, [15, 38]),
            ("0.17", 1, [1, 3]),
        ] {
            let text = FLUME.replacen("spacing_m = 0.01\n", &format!("spacing_m = {h}\n"), 1);
            let text = text.replacen("particles_per_cell = 4", &format!("particles_per_cell = {per_cell}"), 1);
            // The walls of this case are thin for the larger cells, and its window is.
            let text = text.replace("boundary_contact = \"nodes\"", "boundary_contact = \"surface\"");
            let case = case::parse(&text, "flume.toml").unwrap_or_else(|e| panic!("{e}")).case;
            let scene = build(&case);
            let (body, points) = &scene.bodies[0];
            assert_eq!(points.len(), counts[0] * counts[1], "{h}");
            let mass = points.len() as f64 * body.point_mass;
            assert!((mass / 30.0 - 1.0).abs() < 2.1e-5, "{h}: {mass} kg");
            let volume = points.len() as f64 * body.point_volume;
            assert!((volume * 1500.0 / mass - 1.0).abs() < 1e-12, "{h}");
            let spacing = case.bodies[0].lattice(&case.grid).spacing_m;
            for (axis, [low, high]) in [[-0.2, 0.0], [0.0, 0.5]].into_iter().enumerate() {
                let ends = points.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], p| {
                    [a.min(p.x[axis] - 0.5 * spacing[axis]), b.max(p.x[axis] + 0.5 * spacing[axis])]
                });
                assert!((ends[0] - low).abs() < 1e-5 && (ends[1] - high).abs() < 1e-5, "{h}: {ends:?}");
            }
            let sides = [0.2, 0.5];
            assert!((0..2).all(|d| spacing[d] * counts[d] as f64 <= sides[d] * (1.0 + 1.1e-5)), "{h}");
        }
    }
}

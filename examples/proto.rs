use checkdam::body::*; use checkdam::boundary::*; use checkdam::constitutive::*; use checkdam::grid::*; use checkdam::shape::*; use checkdam::simulation::*;
use nalgebra::Vector2;
fn main(){
    let a: Vec<String> = std::env::args().collect();
    let h: f64 = a.get(1).map_or(0.01, |s| s.parse().unwrap());
    let threads: usize = a.get(2).map_or(1, |s| s.parse().unwrap());
    let tend: f64 = a.get(3).map_or(3.0, |s| s.parse().unwrap());
    let deg: f64 = a.get(4).map_or(40.0, |s| s.parse().unwrap());
    let scheme = match a.get(5).map(|s| s.as_str()) { Some("usl") => Scheme::Usl, Some("usf") => Scheme::Usf, _ => Scheme::Musl };
    rayon::ThreadPoolBuilder::new().num_threads(threads).build_global().unwrap();
    let n=2; let s=h/n as f64; let th=0.2;
    let law=AnyLaw::DruckerPrager(DruckerPrager::new(LinearElastic::new(1e6,0.3),Cone::TriaxialCompression,31f64.to_radians(),0.,0.,0.,true));
    let body=Body{name:"sand".into(),law,point_mass:1500.*s*s*th,point_volume:s*s*th,points_per_direction:n,point_spacing:s};
    let mut ps=vec![]; let (nx,ny)=((0.2/s).round() as usize,(0.5/s).round() as usize);
    for i in 0..nx { for j in 0..ny { ps.push(Particle::at_rest(ps.len() as u32,[-0.2+(i as f64+0.5)*s,(j as f64+0.5)*s])); } }
    let v=|x,y|Vector2::new(x,y);
    let b=vec![Boundary::plane("base",v(0.,0.),v(0.,1.),Friction::Coulomb(0.4)),
      Boundary::wall("back",v(-0.2,0.),v(0.,1.),0.6,0.1,Friction::Smooth).facing_right(),
      Boundary::wall("gate",v(0.,0.),v(0.,1.),0.5,h,Friction::Smooth).gate(Opening::Vanish),
      Boundary::wall("barrier",v(1.2,0.),v(0.,1.),0.6,0.1,Friction::Coulomb(0.4))];
    let mut sim=Simulation::new(Scene{lattice:Lattice{spacing:h,origin:[0.,0.]},thickness:th,domain:[[-0.4,1.8],[-0.1,1.5]],bodies:vec![(body,ps)],boundaries:b,gravity:[0.,-9.81],side_wall_friction:0.,
      numerics:Numerics{scheme,shape:ShapeFunction::Ugimp,cfl:0.3,max_time_step:1.0,pic:PicShare::Fraction(5e-4)}});
    let t0=std::time::Instant::now();
    sim.set_damping(60.);
    while sim.time()<0.3 { sim.step().unwrap(); }
    for k in 0..=200 { let th=deg.to_radians()*k as f64/200.; sim.set_gravity([9.81*th.sin(),-9.81*th.cos()]); let t1=sim.time()+0.5/200.; while sim.time()<t1 {sim.step().unwrap();} }
    let t1=sim.time()+0.2; while sim.time()<t1 {sim.step().unwrap();}
    let st=sim.stock(); println!("settled KE {:e} mom {:?} steps {} n {} wall {:?}", st.kinetic, st.momentum, sim.steps(), sim.particle_count(), t0.elapsed());
    for (b,t) in sim.boundaries().iter().zip(sim.step_tallies()) { println!("{} {:?}", b.name, [t.impulse[0]/sim.time_step().dt,t.impulse[1]/sim.time_step().dt]); }
    sim.set_damping(0.); sim.open_ledger(); sim.set_time(0.); sim.release_gates();
    let (s0,t0)=(sim.steps(),std::time::Instant::now());
    let mut next=0.0; let mut acc=0.0; let mut tacc=0.0; let mut done=0usize; let mut peak=0f64;
    while sim.time()<tend { sim.step().unwrap(); done+=sim.particle_count(); let dt=sim.time_step().dt; let f= -sim.step_tallies()[3].impulse[0]; peak=peak.max(-f/dt); acc-=f*1.0; tacc+=dt;
      if sim.time()>=next { next+=0.1; let now=sim.stock(); let e=sim.energy_balance(&now,[1.2,0.0]); let e0=e.initial;
        let led=sim.ledger(); let imp=led.impulse(); let o=sim.opening();
        let front=sim.particles().map(|(_,p)|p.x[0]).fold(-1.,f64::max);
        println!("t {:.2} F {:8.2} front {:.3} KE {:.4} PE {:.4} El {:.5} pl {:.4} fr {:?} ct {:?} pic {:.4} res {:.5} mom {:.1e} dt {:.2e}", sim.time(), -acc/tacc, front, e.kinetic/e0,e.gravitational/e0,e.elastic/e0,e.plastic/e0,
          e.friction.iter().map(|x|(x/e0*1e4).round()/1e4).collect::<Vec<_>>(), e.contact.iter().map(|x|(x/e0*1e5).round()/1e5).collect::<Vec<_>>(), e.pic/e0,e.residual/e0,
          ((now.momentum[0]-o.momentum[0]-imp[0]).abs()+(now.momentum[1]-o.momentum[1]-imp[1]).abs())/led.impulse_scale, dt); acc=0.;tacc=0.; } }
    let w=t0.elapsed().as_secs_f64(); println!("peak {} E0 {} steps {} in {:.2}s: {:.2} M particle-steps/s", peak, sim.energy_balance(&sim.stock(),[1.2,0.]).initial, sim.steps()-s0, w, done as f64/w/1e6);
    let mut hsh=0u64; for (_,p) in sim.particles(){ hsh=hsh.rotate_left(5)^p.x[0].to_bits()^p.v[1].to_bits().rotate_left(17)^p.state.stress.xy.to_bits(); } println!("hash {hsh:x}");
}

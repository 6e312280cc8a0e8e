//! What a dense matrix says of a solution: its fields and figures, its certificate, its load, the equilibrium next to
//! it and whether that is stable.

mod certificate;
mod neighbour;

use std::result::Result;

use asperity::stability::{StabilityTest, Verdict};
use asperity::*;
use ndarray::Array2;

use oracles::dense::{Dense, Held, dot};
use oracles::scenes::{Constraint, Kind, Scene};

/// The roundings that a sum over some nodes may have.
const ROUNDINGS: f64 = 64.0;

/// A solution with the dense matrix of its body: fields at the nodes that face it, in `f64`.
pub struct Judge<'a, T: Real> {
    scene: &'a Scene,
    report: &'a Report,
    solution: &'a Solution<T>,
    dense: Dense,
    held: Held,
    heights: Vec<f64>,
    /// to the surface as it was: negative by the plastic depth
    gap: Vec<f64>,
    /// the plastic depth
    depth: Vec<f64>,
    /// the most that the wall bears
    most: f64,
    pressure: Vec<f64>,
    contact: Vec<f64>,
    /// what the law and the springs of a wall do at each node: tractions
    tractions: Vec<f64>,
    springs: Vec<f64>,
    /// the share of the law at each node, by its work of adhesion, and none where surfaces do not attract each other
    share: Vec<f64>,
    /// the pressure that rounding makes of a gap
    rounding: f64,
    /// the same as an energy norm
    noise: f64,
    /// the scale of the relative error: the mean of u·p that the report says, without contact the surface's
    scale: Option<f64>,
}

fn need(good: bool, what: impl FnOnce() -> String) -> Result<(), String> {
    if good { Ok(()) } else { Err(what()) }
}

fn close(name: &str, found: f64, expected: f64, allowed: f64) -> Result<(), String> {
    need((found - expected).abs() <= allowed, || format!("{name}: {found:e} is not {expected:e} (± {allowed:e})"))
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0_f64, |a, b| a.max(b.abs()))
}

impl<'a, T: Real> Judge<'a, T> {
    pub fn new(
        scene: &'a Scene,
        solution: &'a Solution<T>,
        wall: asperity::constraint::Wall<'_, T>,
        operator: &dyn ElasticOperator<T>,
    ) -> Self {
        let (dense, heights, report) = (scene.dense(), scene.centred(), &solution.report);
        let held = scene.held(&dense);
        let at_faces = |field: &Array2<T>| -> Vec<f64> {
            let field = field.as_slice().expect("in rows");
            dense.faces.iter().map(|&node| field[node].widen()).collect()
        };
        let [gap, pressure, contact] = [&solution.gap, &solution.pressure, &solution.contact_pressure].map(at_faces);
        let depth: Vec<f64> = solution.plastic_depth.as_ref().map_or_else(|| vec![0.0; gap.len()], at_faces);
        let gap: Vec<f64> = gap.iter().zip(&depth).map(|(gap, depth)| gap - depth).collect();
        let most = T::lit(scene.hardness).widen();
        let law = scene.law.of_gap::<T>();
        let soft = scene.constraint == Constraint::None;
        let within = |g: f64| T::lit(if soft { g } else { g.max(0.0) });
        let faces = || dense.faces.iter().zip(&gap);
        let touched =
            |node: usize| solution.touched.as_ref().is_none_or(|near| near.as_slice().expect("in rows")[node]);
        let share = |&node: &usize| if touched(node) { scene.law.share(node) } else { 0.0 };
        let share: Vec<f64> = dense.faces.iter().map(share).collect();
        let tractions: Vec<f64> =
            share.iter().zip(&gap).map(|(share, &g)| share * law.traction(within(g)).widen()).collect();
        let springs: Vec<f64> = match wall {
            asperity::constraint::Wall::Springs(springs) => {
                faces().map(|(&i, &g)| springs.traction(i, T::lit(g)).widen()).collect()
            }
            _ => depth.iter().map(|&depth| if depth > 0.0 { -most } else { 0.0 }).collect(),
        };
        let (epsilon, (softest, stiffest)) = (T::epsilon().widen(), operator.stiffness_range());
        let nodes = operator.grid().nodes() as f64;
        let length = largest(&heights).max(largest(&gap));
        let rounding = ROUNDINGS
            * epsilon
            * (nodes.sqrt() * stiffest * length
                + report.net_pressure.abs().max(report.mean_pressure.abs())
                + largest(&tractions)
                + largest(&springs));
        let noise = if softest > 0.0 { rounding / softest.sqrt() } else { 0.0 };
        // a rigid shift is no wave: its energy is not in the scale
        let padding = nodes / dense.nodes as f64;
        let of_mean = match report.boundary {
            Boundary::Free { mean_compliance, .. } => mean_compliance * report.net_pressure.powi(2) / padding,
            _ => 0.0,
        };
        let work = 2.0 * report.elastic_energy - of_mean;
        let surface = dense.work(&heights);
        let scale = match report.contact_nodes > 0 {
            // nodes that bear their own attraction may deform nothing
            true => Some(work).filter(|&work| work > (ROUNDINGS * epsilon).powi(2) * surface),
            false if scene.is_whole() => Some(work.max(surface)),
            // of the heights as they continue where there is no surface
            false => None,
        };
        // where the attraction that nodes bear themselves deforms no more than rounding, it is what that would deform
        let strength = if scene.law.shares.is_some() { 2.0 } else { 1.0 } * scene.law.work / scene.law.range;
        let attracts = strength * -report.adhesive_energy / scene.law.range / stiffest;
        let scale = scale.map(|scale| {
            let named = scene.constraint == Constraint::None || report.error_scale <= 1.01 * scale.max(attracts);
            if named { scale.max(report.error_scale) } else { scale }
        });
        let scale = scale.filter(|&scale| scale > 0.0 && !scene.is_flat() && report.relative_error.is_finite());
        Self {
            scene,
            report,
            solution,
            dense,
            held,
            heights,
            gap,
            depth,
            most,
            pressure,
            contact,
            tractions,
            springs,
            share,
            rounding,
            noise,
            scale,
        }
    }

    fn epsilon() -> f64 {
        T::epsilon().widen()
    }

    fn mean(&self, values: &[f64]) -> f64 {
        values.iter().sum::<f64>() / self.dense.nodes as f64
    }

    /// The displacement of the faces.
    fn displacement(&self) -> Vec<f64> {
        self.gap.iter().zip(&self.heights).map(|(g, h)| g + h).collect()
    }

    fn projects(&self) -> bool {
        matches!(self.scene.constraint, Constraint::Hard | Constraint::Paper | Constraint::Hardness)
    }

    fn detached(&self) -> bool {
        self.report.status == Status::Detached
    }

    fn converged(&self) -> bool {
        self.report.status == Status::Converged
    }

    fn tolerance(&self) -> f64 {
        self.scene.settings.tolerance_in::<T>()
    }

    /// All that is judged by the solution alone; how far it is from an exact equilibrium over how far it may be.
    pub fn all(&self) -> Result<Option<f64>, String> {
        self.fields()?;
        self.neighbourhood()?;
        self.control()?;
        self.elasticity()?;
        self.certificate()?;
        self.claim()?;
        self.neighbour()
    }

    /// Checks feasibility, and that figures and fields agree.
    fn fields(&self) -> Result<(), String> {
        let Self { scene, report, solution, contact, pressure, depth, most, .. } = self;
        let (raw, gap) = (&self.gap, self.gap.iter().zip(depth).map(|(gap, depth)| gap + depth).collect::<Vec<_>>());
        need(gap.iter().chain(pressure).chain(contact).all(|x| x.is_finite()), || "a field is not finite".into())?;
        let absent = scene.heights.iter().zip(&solution.gap).zip(&solution.pressure).filter(|((h, _), _)| h.is_nan());
        let empty = |((_, g), p): ((&f64, &T), &T)| g.is_infinite() && p.widen() == 0.0;
        need(absent.clone().all(empty), || "something at an absent node".into())?;
        need(report.absent_nodes == absent.count(), || format!("{} absent nodes", report.absent_nodes))?;
        need(contact.iter().all(|&p| p >= 0.0), || "a contact pressure is negative".into())?;
        if self.projects() {
            need(gap.iter().all(|&g| g >= 0.0), || "a gap is negative".into())?;
            need(gap.iter().zip(contact).all(|(g, p)| g * p == 0.0), || "complementarity".into())?;
        }
        if scene.constraint == Constraint::Hardness {
            let plastic = report.plastic.ok_or("nothing plastic")?;
            need(contact.iter().all(|p| p <= most), || "more than the hardness".into())?;
            let yields = |((&d, &p), &g): ((&f64, &f64), &f64)| d == 0.0 || d > 0.0 && p == *most && g == 0.0;
            need(depth.iter().zip(contact).zip(&gap).all(yields), || "a depth where nothing yields".into())?;
            let (count, sum) = (depth.iter().filter(|&&d| d > 0.0).count(), depth.iter().sum::<f64>());
            let of = depth.len() as f64;
            close("yielded share", plastic.fraction, count as f64 / of, f64::EPSILON)?;
            close("greatest depth", plastic.depth_max, largest(depth), 0.0)?;
            close("mean depth", plastic.depth_mean, sum / of, ROUNDINGS * f64::EPSILON * sum / of)?;
        }
        let touching = solution.contact_map().iter().filter(|&&touches| touches).count();
        // without a wall a node at the gap of rest touches or does not
        let edge = ROUNDINGS * Self::epsilon() * scene.law.work / scene.law.range;
        let at_rest = self.tractions.iter().filter(|t| scene.constraint == Constraint::None && t.abs() <= edge).count();
        let counted = report.contact_nodes.abs_diff(touching) <= at_rest;
        need(counted, || format!("{} nodes touch, not {touching}", report.contact_nodes))?;
        let fraction = report.contact_nodes as f64 / gap.len() as f64;
        close("contact fraction", report.contact_fraction, fraction, 0.0)?;
        close("least gap", report.min_gap, gap.iter().copied().fold(f64::INFINITY, f64::min), 0.0)?;
        let (count, sums) = (gap.len() as f64, ROUNDINGS * Self::epsilon());
        let size = raw.iter().map(|g| g.abs()).sum::<f64>() / count;
        close("mean gap", report.mean_gap, gap.iter().sum::<f64>() / count, sums * size)?;
        close("mean contact pressure", report.mean_contact_pressure, self.mean(contact), sums * self.mean(contact))?;
        let carried = self.mean(contact) - self.mean(&self.tractions);
        let terms = self.mean(contact) + self.mean(&self.tractions.iter().map(|t| t.abs()).collect::<Vec<_>>());
        // without a wall the law is both
        let carried = if scene.constraint == Constraint::None { -self.mean(&self.tractions) } else { carried };
        let allowed = sums * terms + self.of_law(sums * scene.law.work / scene.law.range);
        close("net pressure", report.net_pressure, carried, allowed)
    }

    /// That surfaces which attract each other next to contacts alone do so within four nodes of every contact.
    fn neighbourhood(&self) -> Result<(), String> {
        let (Some(touched), true) = (&self.solution.touched, self.converged()) else { return Ok(()) };
        let ((nx, ny), (dx, dy)) = (self.scene.grid.shape(), self.scene.grid.spacing());
        let reach = 4.2 * self.scene.grid.largest_spacing();
        let periodic = self.report.boundary == Boundary::Periodic;
        let away = |a: usize, b: usize, n: usize| {
            let straight = a.abs_diff(b);
            if periodic { straight.min(n - straight) } else { straight }
        };
        for ((x, y), _) in self.solution.gap.indexed_iter().filter(|(_, gap)| **gap <= T::zero()) {
            let lacks = touched.indexed_iter().find(|&((i, j), &touched)| {
                let [across, along] = [away(x, i, nx) as f64 * dx, away(y, j, ny) as f64 * dy];
                across.hypot(along) <= reach && !touched
            });
            need(lacks.is_none(), || format!("{:?} is near the contact of {x}, {y}", lacks.map(|(node, _)| node)))?;
        }
        Ok(())
    }

    /// That what is held is held.
    fn control(&self) -> Result<(), String> {
        let Self { scene, report, gap, .. } = self;
        let (epsilon, (lx, ly)) = (Self::epsilon(), scene.grid.lengths());
        let size = gap.iter().map(|g| g.abs()).sum::<f64>() / gap.len() as f64;
        let area = lx * ly;
        close(
            "force",
            report.normal_force,
            report.mean_pressure * area,
            8.0 * f64::EPSILON * report.normal_force.abs(),
        )?;
        let length = size + largest(&self.heights);
        // to the surface as it was
        let mean_gap = report.mean_gap - report.plastic.map_or(0.0, |plastic| plastic.depth_mean);
        match scene.control {
            Control::MeanGap(given) => close("given gap", mean_gap, given, 1e3 * epsilon * size),
            _ if self.detached() => Ok(()),
            Control::MeanPressure(given) => close("load", report.mean_pressure, given, epsilon * given.abs()),
            Control::Force(given) => close("given force", report.normal_force, given, 4.0 * epsilon * given.abs()),
            Control::Approach(given) => {
                let found = report.approach.ok_or("no approach")?;
                close("given approach", found, given, ROUNDINGS * epsilon * (length + given.abs()))
            }
            Control::Spring { stiffness, rest } => {
                let length = length + rest.abs() + report.approach.unwrap_or(0.0).abs();
                let stretched = report.approach.map_or(mean_gap - rest, |approach| rest - approach);
                // what the mean displacement of the half-space takes of the force
                let allowed = ROUNDINGS * epsilon * (stiffness * length + report.normal_force.abs());
                close("force of the spring", report.normal_force, stiffness * stretched, allowed)
            }
            other => panic!("{other:?}"),
        }
    }

    /// The distance from what is exact that the report admits, in the energy norm.
    fn admitted(&self) -> Option<f64> {
        Some(self.report.relative_error * self.scale?.sqrt())
    }

    /// Checks that the pressure belongs to the displacement, and the energies to the fields.
    fn elasticity(&self) -> Result<(), String> {
        let Self { scene, report, dense, gap, pressure, rounding, .. } = self;
        let u = self.displacement();
        let external = if self.detached() { self.mean(pressure) } else { report.mean_pressure };
        if scene.is_whole() {
            for (found, p) in pressure.iter().zip(dense.pressure(&u)) {
                close("pressure", *found, p + external, *rounding)?;
            }
        } else if let (Some(admitted), false) = (self.admitted(), self.detached()) {
            // where nothing faces the body the pressure vanishes but for the error
            let bent = dense.displacement(pressure);
            let off: Vec<f64> = u.iter().zip(&bent).map(|(u, bent)| u - bent).collect();
            let distance = dense.work(&off).sqrt();
            // a bound but for what the residuals of both kinds of nodes have in common, and for a load that is missed
            let allowed = 4.0 * (admitted + self.noise) + self.unbalanced() / dense.softest.sqrt();
            need(distance <= allowed, || format!("the pressure is off by {distance:e} (± {allowed:e})"))?;
            if let Some(approach) = report.approach {
                let top = self.heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                let unbalanced = self.load_noise() + self.unbalanced();
                let slack = (allowed + unbalanced / dense.rigid.sqrt()) / dense.rigid.sqrt();
                close("approach", approach, top - dense.shift(&off), slack)?;
            }
        }
        if let (Some(admitted), false) = (self.admitted(), self.detached()) {
            // a uniform pressure is no wave of a periodic cell
            let uniform = if scene.is_whole() { self.mean(pressure) } else { 0.0 };
            let waves: Vec<f64> = pressure.iter().map(|p| p - uniform).collect();
            let (found, expected) = ((2.0 * report.elastic_energy).sqrt(), dense.compliant(&waves).sqrt());
            let soft = if dense.rigid.is_finite() {
                (self.load_noise() + self.unbalanced()) / dense.rigid.sqrt()
            } else {
                0.0
            };
            let sums = Self::epsilon().sqrt() * expected;
            close("root of the elastic work", found, expected, 4.0 * (admitted + self.noise + soft) + sums)?;
        }
        if self.depth.iter().any(|&depth| depth > 0.0) {
            return Ok(());
        }
        let (law, epsilon) = (scene.law.of_gap::<T>(), Self::epsilon());
        let energy = |(share, &g): (&f64, &f64)| {
            let inside = if scene.constraint == Constraint::None { 0.0 } else { g.min(0.0) };
            let bent = if inside < 0.0 { inside * law.traction(T::zero()).widen() } else { 0.0 };
            let energy = law.energy(T::lit(g - inside)).widen() + bent;
            share * energy
        };
        let energies: Vec<f64> = self.share.iter().zip(gap).map(energy).collect();
        let steep: f64 = self.tractions.iter().zip(gap).map(|(t, g)| (t * g).abs()).sum();
        let size = energies.iter().map(|e| e.abs()).sum::<f64>() + 4.0 * steep;
        let decay = (largest(gap) / scene.law.range).min(100.0);
        let allowed = self.of_law(ROUNDINGS * epsilon * scene.law.work)
            + ROUNDINGS * epsilon * (1.0 + decay) * size / dense.nodes as f64;
        close("adhesive energy", report.adhesive_energy, self.mean(&energies), allowed)
    }

    /// The rounding of a law that is evaluated far from contact.
    fn of_law(&self, size: f64) -> f64 {
        if self.scene.law.is_none() { 0.0 } else { size + T::min_positive_value().widen() }
    }

    /// The pressure to which the error of the load is relative.
    fn size(&self) -> f64 {
        let (report, law) = (self.report, &self.scene.law);
        let unloaded = report.mean_pressure == 0.0 && !law.is_none();
        let attraction = if unloaded { -report.adhesive_energy / law.range } else { 0.0 };
        report.mean_pressure.abs().max(report.mean_contact_pressure).max(attraction)
    }

    /// The mean pressure that the report admits to be missing.
    fn unbalanced(&self) -> f64 {
        let report = self.report;
        report.load_error * self.size()
    }

    /// What rounding does to the load of a spring.
    fn load_noise(&self) -> f64 {
        let rest = if let Held::Spring { rest, .. } = self.held { rest.abs() } else { 0.0 };
        let length = rest + largest(&self.heights) + largest(&self.gap);
        ROUNDINGS * Self::epsilon() * (self.held.stiffness() * length + self.report.mean_pressure.abs())
    }

    /// The terms of the sum of the energy, per area.
    pub fn magnitude(&self) -> f64 {
        let u = self.rounding / (ROUNDINGS * Self::epsilon());
        let lengths = self.mean(&self.gap.iter().map(|g| g.abs()).collect::<Vec<_>>());
        self.dense.work(&self.heights) + u * lengths + self.report.adhesive_energy.abs()
    }

    /// How far rounding alone lets a state be from equilibrium, relative to the scale and to the load.
    pub fn is_at_floor(&self, operator: &dyn ElasticOperator<T>) -> bool {
        let (stiffest, report) = (operator.stiffness_range().1, self.report);
        let mean = self.gap.iter().map(|g| g.abs()).sum::<f64>() / self.gap.len() as f64;
        let rms = (dot(&self.heights, &self.heights) / self.heights.len() as f64).sqrt();
        let rounded = self.dense.work(&self.heights) + stiffest * mean * (mean + rms);
        let floor = Self::epsilon() * (rounded / report.elastic_energy).sqrt();
        let size = self.size();
        let of_load = self.load_noise() / size + Self::epsilon() * stiffest * (mean + rms) / size;
        let within = |error: f64, floor: f64| error <= self.tolerance() || error < 40.0 * floor;
        within(report.relative_error, floor) && within(report.load_error, floor.max(of_load))
    }
}

//! The equilibrium next to a solution, and whether that is stable.

use super::*;

impl<T: Real> Judge<'_, T> {
    /// The nodes that may move.
    pub(super) fn free(&self) -> Vec<usize> {
        (0..self.gap.len()).filter(|&i| !self.projects() || self.gap[i] != 0.0).collect()
    }

    /// The traction and the slope of a node's energy, in `f64`.
    pub(super) fn local<'b>(&'b self, law: &'b dyn AdhesionLaw<f64>) -> impl Fn(usize, f64) -> [f64; 2] + 'b {
        move |i, gap| {
            let share = self.share[i];
            let soft = self.scene.constraint == Constraint::None;
            let [traction, slope] =
                if soft || gap >= 0.0 { [law.traction(gap), law.slope(gap)] } else { [law.traction(0.0), 0.0] };
            let spring =
                if self.scene.constraint == Constraint::Penalty && gap < 0.0 { self.scene.stiffness } else { 0.0 };
            [share * traction + spring * gap, share * slope + spring]
        }
    }

    /// That a converged state is as near to an exact equilibrium as it says, where that is a minimum by some margin;
    /// how far it is over how far it may be, if there is one to compare with.
    pub(super) fn neighbour(&self) -> Result<Option<f64>, String> {
        let law = self.scene.law.of_gap::<f64>();
        let local = self.local(&*law);
        let slopes: Vec<f64> = self.gap.iter().enumerate().map(|(i, &g)| local(i, g)[1]).collect();
        let (Some(admitted), true) = (self.admitted(), self.converged() && self.scene.constraint != Constraint::Uzawa)
        else {
            return Ok(None);
        };
        // a law that attracts makes of the residual an error as large as the softest mode lets it
        let (free, attracts) = (self.free(), slopes.iter().fold(0.0_f64, |most, slope| most.max(-slope)));
        let mut margin = f64::INFINITY;
        if attracts > 0.0 && !free.is_empty() {
            margin = self.dense.softest;
            while margin > 1e-3 * self.dense.softest && self.dense.below(&free, self.held, &slopes, margin) > 0 {
                margin *= 0.25;
            }
            if margin <= 1e-3 * self.dense.softest {
                return Ok(None);
            }
        }
        let amplified = if attracts > 0.0 { 1.0 + attracts / margin } else { 1.0 };
        // at the mean gap that the state has, where that is held; and with springs and walls that yield, where the error
        // of the load makes more than the matrix says, as some come to rest
        let gives = matches!(self.scene.constraint, Constraint::Penalty | Constraint::Hardness);
        let held = match self.held {
            Held::Pressure(_) | Held::Spring { .. } if !gives => self.held,
            _ => Held::Shift(self.dense.shift(&self.displacement())),
        };
        let most = self.projects().then_some(self.most);
        let Some(exact) = self.dense.equilibrium(&self.heights, held, &local, most, &self.gap) else {
            return Ok(None);
        };
        let off: Vec<f64> = self.gap.iter().zip(&exact).map(|(a, b)| a - b).collect();
        // of a law that bends on the way the matrix at one end says little
        let bend = |(i, &gap): (usize, &f64)| (local(i, gap)[1] - slopes[i]).abs();
        let bent = exact.iter().enumerate().map(bend).fold(0.0_f64, f64::max);
        let jumps = self.scene.law.base == Kind::MaugisDugdale
            && self.gap.iter().zip(&exact).any(|(a, b)| local(0, *a)[0] != local(0, *b)[0]);
        if attracts > 0.0 && bent > 0.3 * margin.min(attracts) || jumps {
            return Ok(None);
        }
        let distance = self.dense.work(&off).sqrt();
        let mut allowed = admitted + self.noise;
        if !matches!(held, Held::Shift(_)) {
            let unbalanced = self.unbalanced() + self.load_noise() + self.rounding;
            // of a law that bends on the way
            let others: Vec<f64> = exact.iter().enumerate().map(|(i, &g)| local(i, g)[1]).collect();
            allowed += unbalanced * self.reach(&free, held, &slopes).max(self.reach(&free, held, &others));
        }
        // the norm in which a law holds nodes is not the norm of the waves alone
        allowed *= amplified * if self.scene.constraint == Constraint::None { 1.1 } else { 1.01 };
        need(distance <= allowed, || {
            format!(
                "claims {allowed:e} ({:e}, amplified by {amplified:.1}) and is {distance:e} off",
                self.report.relative_error
            )
        })?;
        Ok(Some(distance / allowed))
    }

    /// The most that the energy norm changes for a unit change of the load.
    pub(super) fn reach(&self, free: &[usize], held: Held, slopes: &[f64]) -> f64 {
        let (dense, nodes) = (&self.dense, self.dense.nodes as f64);
        let touching = (0..self.gap.len()).filter(|i| !free.contains(i));
        // a displacement that leaves a node where it is
        let pinned = touching.map(|i| {
            let force: Vec<f64> = dense
                .share
                .iter()
                .enumerate()
                .map(|(j, share)| nodes * (share - f64::from(u8::from(i == j))))
                .collect();
            dense.compliant(&force).sqrt()
        });
        let least = pinned.fold(f64::INFINITY, f64::min);
        if least.is_finite() {
            return least;
        }
        let right = free.iter().map(|&i| nodes * dense.share[i]).collect();
        let step = oracles::dense::eliminate(dense.hessian(free, held, slopes, 0.0), right).unwrap_or_default();
        if step.len() == free.len() { dense.work(&step).sqrt() } else { 0.0 }
    }

    /// Checks the verdicts on the stability by the pivots of the second derivative: under the control, and under the
    /// pressure that holds a given mean gap. Returns the verdicts.
    pub fn stability(
        &self,
        problem: &mut Problem<T>,
        constraint: &dyn ContactConstraint<T>,
    ) -> Result<Vec<Verdict>, String> {
        let (scene, free) = (self.scene, self.free());
        let jumps = scene.law.base == Kind::MaugisDugdale;
        let rounds = matches!(scene.constraint, Constraint::Uzawa | Constraint::Hardness);
        if scene.law.is_none() || jumps || rounds || !self.converged() || free.len() < 3 {
            return Ok(Vec::new());
        }
        let law = scene.law.of_gap::<f64>();
        let local = self.local(&*law);
        let slopes: Vec<f64> = self.gap.iter().enumerate().map(|(i, &g)| local(i, g)[1]).collect();
        let steepest = largest(&slopes) + self.dense.stiffest;
        let margin = (1e-3 * self.dense.softest).max(ROUNDINGS * Self::epsilon() * steepest);
        let pressure = self.report.mean_pressure;
        let loads = [(scene.control, self.held), (Control::MeanPressure(pressure), Held::Pressure(pressure))];
        let loads = &loads[..if matches!(self.held, Held::Shift(_)) { 2 } else { 1 }];
        let verdict = |&(control, held): &(Control, Held)| {
            let test = StabilityTest::under(control).run_with(problem, constraint, self.solution);
            let stability = test.map_err(|error| format!("no stability test: {error}"))?;
            let below = |number: f64| self.dense.below(&free, held, &slopes, number);
            let (value, bound) = (stability.eigenvalue, stability.lower_bound);
            match stability.verdict {
                Verdict::Stable => need(below(-margin) == 0, || format!("stable with {value:e}, but it is a saddle"))?,
                Verdict::Unstable => {
                    need(below(margin) > 0, || format!("unstable with {value:e}, but it is a minimum"))?
                }
                _ => {}
            }
            if scene.is_whole() && stability.verdict != Verdict::Undecided {
                let allowed = 1e-3 * value.abs() + margin;
                let (less, more) = (below(bound - allowed), below(value + allowed));
                let least = less == 0 && more > 0;
                need(least, || format!("{bound:e} to {value:e} is not the least: {less} below, {more} above"))?;
            }
            Ok(stability.verdict)
        };
        loads.iter().map(verdict).collect()
    }
}

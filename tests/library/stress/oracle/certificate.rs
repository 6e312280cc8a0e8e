//! The certificate of a solution: its residual, and the error that it claims.

use super::*;

impl<T: Real> Judge<'_, T> {
    /// The residual of equilibrium where nodes may move, its level, and whether rounding decides which may.
    pub(super) fn residual(&self) -> (Vec<f64>, f64, bool) {
        let (u, n) = (self.displacement(), self.gap.len());
        let centred = self.detached() || matches!(self.held, Held::Shift(_));
        let mean = match self.held {
            _ if centred => 0.0,
            Held::Pressure(pressure) => pressure,
            held => held.pressure(self.dense.shift(&u)),
        };
        let share: Vec<f64> = self.dense.share.iter().map(|share| share * self.dense.nodes as f64).collect();
        let full = self.dense.full(&u, mean);
        let mut r: Vec<f64> = (0..n).map(|i| full[i] + self.tractions[i] + self.springs[i]).collect();
        let free: Vec<bool> = self.gap.iter().map(|&g| !self.projects() || g != 0.0).collect();
        let level = |r: &[f64], of: &[bool]| {
            let sum = |values: &[f64]| (0..n).filter(|&i| of[i]).map(|i| values[i]).sum::<f64>();
            if centred && of.contains(&true) { sum(r) / sum(&share) } else { 0.0 }
        };
        let lowest = (0..n).map(|i| r[i] / share[i]).fold(f64::INFINITY, f64::min);
        let release = if centred && !free.contains(&true) { lowest } else { level(&r, &free) };
        // how far a node that touches is from where it comes off, and from where it yields
        let over =
            |r: &[f64], release: f64, i: usize| [r[i] - release * share[i], r[i] - release * share[i] - self.most];
        let clear = (0..n).all(|i| free[i] || over(&r, release, i).iter().all(|over| over.abs() > self.rounding));
        let moves = |r: &[f64], release: f64, i: usize| {
            let [off, deeper] = over(r, release, i);
            (free[i] || off < 0.0 || deeper > 0.0, !free[i] && deeper > 0.0)
        };
        let working = |r: &mut [f64], release: f64| -> Vec<bool> {
            let moves: Vec<_> = (0..n).map(|i| moves(r, release, i)).collect();
            r.iter_mut().zip(&moves).for_each(|(r, (_, yields))| *r -= if *yields { self.most } else { 0.0 });
            moves.into_iter().map(|(moves, _)| moves).collect()
        };
        let mut first = r.clone();
        let moved = working(&mut first, release);
        // where some yield, both sides of the corner have one level
        let yields = self.depth.iter().any(|&depth| depth > 0.0) || first != r;
        let release = if centred && yields { level(&first, &moved) } else { release };
        let working = working(&mut r, release);
        let level =
            level(if centred && yields { &first } else { &r }, if centred && yields { &moved } else { &working });
        let residual = (0..n).map(|i| if working[i] { r[i] - level * share[i] } else { 0.0 }).collect();
        (residual, release, clear)
    }

    /// Checks that the certificate is no less than the certificate of the matrix, nor far more.
    pub(super) fn certificate(&self) -> Result<(), String> {
        let (mut residual, _, clear) = self.residual();
        // with multipliers the last round is what was certified, and the stiffness of springs, or of a law without a
        // wall, is in it
        let own = !matches!(self.scene.constraint, Constraint::Penalty | Constraint::Uzawa | Constraint::None);
        let Some(scale) = self.scale.filter(|_| clear && own) else {
            return Ok(());
        };
        let (said, noise) = (self.report.relative_error, self.noise / scale.sqrt());
        let reaches =
            |own: f64| need(own <= 1.001 * said + 4.0 * noise, || format!("certificate {said:e} is less than {own:e}"));
        if !self.scene.is_whole() {
            return reaches((self.held_error(&residual) / scale).sqrt());
        }
        let sum: f64 = residual.iter().sum();
        residual.iter_mut().zip(&self.dense.share).for_each(|(r, share)| *r -= sum * share);
        let own = (self.dense.compliant(&residual) / scale).sqrt();
        reaches(own)?;
        let light = scale < 1e3 * Self::epsilon() * self.dense.work(&self.heights);
        let allowed = (0.05 * own + 8.0 * noise).max(self.tolerance());
        need(light || said <= own + allowed, || format!("certificate {said:e} is far more than {own:e}"))
    }

    /// The work of the displacement that takes a residual away at the present shift, where nodes at zero gap stay there.
    /// The certificate counts the residual of absent nodes too, which the matrix does not know. Absent nodes change the
    /// residual at zero gaps, and with it which of these nodes may move. Whatever they do, the certificate is no less than
    /// this work.
    fn held_error(&self, residual: &[f64]) -> f64 {
        let moving = self.free();
        if moving.is_empty() {
            return 0.0;
        }
        let right = moving.iter().map(|&i| residual[i]).chain([0.0]).collect();
        let hessian = self.dense.hessian(&moving, Held::Shift(0.0), &vec![0.0; residual.len()], 0.0);
        let step = oracles::dense::eliminate(hessian, right).expect("stiff where the shift is held");
        step.iter().zip(&moving).map(|(step, &i)| step * residual[i]).sum::<f64>().max(0.0) / self.dense.nodes as f64
    }

    /// That a solve that says it has converged meets its tolerance and carries its load.
    pub(super) fn claim(&self) -> Result<(), String> {
        let (report, tolerance) = (self.report, self.tolerance());
        if !self.converged() {
            return Ok(());
        }
        let good = report.relative_error <= tolerance && report.load_error <= tolerance;
        need(good, || format!("converged with {:e}, {:e}", report.relative_error, report.load_error))?;
        if matches!(self.held, Held::Shift(_)) {
            return Ok(());
        }
        let size = self.size();
        let magnitude =
            self.mean(&self.contact).max(self.mean(&self.tractions.iter().map(|t| t.abs()).collect::<Vec<_>>()));
        // surfaces apart under no load carry the rounding of what would press them flat
        let apart = if report.mean_pressure == 0.0 && report.contact_nodes == 0 { self.rounding } else { 0.0 };
        let allowed = 1.01 * tolerance * size + ROUNDINGS * Self::epsilon() * magnitude + self.load_noise() + apart;
        close("carried load", report.net_pressure, report.mean_pressure, allowed)
    }
}

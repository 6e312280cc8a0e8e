//! The contacts that bear a pull-off: the share of the cell that they take, their nodes, and their radius.

use std::f64::consts::PI;

use super::fitted::PULL_OFF;
use crate::contact::Clusters;
use crate::pull_off::FoundPullOff;
use crate::real::Real;
use crate::surface::Surface;

impl<T: Real> FoundPullOff<T> {
    /// The share of a periodic cell in contact, by the adhesive energy.
    pub(super) fn closed_share(&self) -> Option<f64> {
        let report = &self.solution.report;
        let facing = 1.0 - report.absent_nodes as f64 / self.solution.grid.nodes() as f64;
        report.adhesive_contact_fraction.filter(|_| report.approach.is_none()).map(|share| share * facing)
    }

    /// The nodes of the contacts that bear the tension, by the adhesive energy, in the mean over these nodes.
    pub(super) fn bearing_nodes(&self) -> f64 {
        let (solution, report) = (self.solution.whole(), &self.solution.report);
        let facing = (solution.grid.nodes() - report.absent_nodes) as f64;
        let by_energy = report.adhesive_contact_fraction.unwrap_or_default() * facing;
        let sizes = Clusters::within(solution.contact_map().view(), report.boundary).sizes;
        let sum = |power: i32| sizes.iter().map(|&size| (size as f64).powi(power)).sum::<f64>();
        if sizes.is_empty() { by_energy } else { by_energy * sum(2) / sum(1).powi(2) }
    }

    /// The radius of the contacts at their pull-off by the theory of Johnson, Kendall and Roberts, in spacings, with the mean
    /// curvature of the surface at the nodes in contact; infinite where they are flat.
    fn radius_by_jkr(&self, surface: &Surface) -> f64 {
        let (solution, heights) = (self.solution.whole(), surface.whole());
        let (heights, grid, report) = (heights.heights(), &solution.grid, &solution.report);
        let ((nx, ny), (dx, dy)) = (grid.shape(), grid.spacing());
        let bend = |[before, here, after]: [f64; 3], spacing: f64| (2.0 * here - before - after) / (spacing * spacing);
        let contact = solution.contact_map();
        let inside = |at: usize, n: usize| report.approach.is_none() || n == 1 || 0 < at && at + 1 < n;
        let (mut sum, mut count) = (0.0, 0.0);
        for ((i, j), _) in
            contact.indexed_iter().filter(|((i, j), touches)| **touches && inside(*i, nx) && inside(*j, ny))
        {
            let along_x = [(i + nx - 1) % nx, i, (i + 1) % nx].map(|i| heights[[i, j]]);
            let along_y = [(j + ny - 1) % ny, j, (j + 1) % ny].map(|j| heights[[i, j]]);
            let axes = f64::from(u8::from(nx > 1)) + f64::from(u8::from(ny > 1));
            let bend_here = (bend(along_x, dx) + bend(along_y, dy)) / axes;
            if bend_here.is_finite() {
                (sum, count) = (sum + bend_here, count + 1.0);
            }
        }
        let curvature = sum / count;
        if curvature.is_nan() || curvature <= 0.0 {
            return f64::INFINITY;
        }
        let cube = 1.125 * PI * report.work_of_adhesion / (report.modulus * curvature * curvature);
        cube.cbrt() / grid.largest_spacing()
    }

    /// The number of nodes of a contact, and how many times as many it needs along the sides, if they are too few.
    pub(super) fn few_nodes(&self, surface: &Surface) -> Option<(f64, f64)> {
        let nodes = self.bearing_nodes();
        let finer = (PULL_OFF.nodes / nodes).sqrt().max(PULL_OFF.radius / self.radius_by_jkr(surface));
        (finer > 1.0).then_some((nodes, finer))
    }
}

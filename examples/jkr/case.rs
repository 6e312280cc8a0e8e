//! A problem with adhesion in a few words, and what is asked of its solutions.

use std::ops::ControlFlow;

use asperity::contact::ContactArea;
use asperity::pull_off::FoundPullOff;
use asperity::{
    Branch, Control, Grid, Problem, PullOff, Result, Settings, Solution, Solver, Start, Status, Westergaard,
};

/// The tolerance of solves, far below the error of the grid.
const TOLERANCE: f64 = 1e-5;

/// The step of the load to both sides between which a stiffness is found, over the mean contact pressure.
const STEP: f64 = 0.05;

/// The area by energy of the zone at the edge of a contact, in cells for each side of a cell on the edge.
pub const ZONE: f64 = 0.16;

/// The areas of a contact, as shares of the nominal area.
#[derive(Clone, Copy)]
pub struct Areas {
    /// By the adhesive energy.
    pub by_energy: f64,
    /// Within the edge between the nodes.
    pub corrected: f64,
    /// By the nodes in contact.
    pub counted: f64,
    /// The nodes in contact.
    pub nodes: usize,
    /// The length of the edge, along the cells.
    pub perimeter: f64,
    /// The edge times the larger spacing of nodes, as a share of the nominal area.
    pub edge: f64,
    /// The work of adhesion over the mean contact pressure.
    pub length: f64,
    /// The mean gap.
    pub mean_gap: f64,
    /// The operator applications of the solve.
    pub applications: usize,
}

impl Areas {
    pub fn of(solution: &Solution<f64>) -> Result<Self> {
        let (report, area) = (&solution.report, ContactArea::of_solution(solution)?);
        let ((lx, ly), (dx, dy)) = (solution.grid.lengths(), solution.grid.spacing());
        // on a line the edge is a number of points
        let (nominal, spacing) = if solution.grid.is_line() { (lx, dx) } else { (lx * ly, dx.max(dy)) };
        Ok(Self {
            by_energy: -report.adhesive_energy / report.work_of_adhesion,
            corrected: area.corrected_contact_fraction,
            counted: area.contact_fraction,
            nodes: area.contact_nodes,
            perimeter: area.perimeter,
            edge: area.perimeter * spacing / nominal,
            length: report.work_of_adhesion / report.mean_contact_pressure,
            mean_gap: report.mean_gap,
            applications: report.operator_applications,
        })
    }

    /// The area by energy of the zone at the edge.
    pub fn zone(&self) -> f64 {
        ZONE * self.edge
    }

    /// The area by energy less the zone at its edge.
    pub fn less_zone(&self) -> f64 {
        self.by_energy - self.zone()
    }

    /// The share of the zone in the area by energy: by so much adhesion at the edge is too strong.
    pub fn zone_share(&self) -> f64 {
        self.zone() / self.by_energy
    }

    /// The length by which the zone brings the bodies together, by the energy of its edge, which grows with the load.
    pub fn zone_length(&self) -> f64 {
        self.length * self.zone()
    }

    /// The mean of the areas by energy and by the edge.
    pub fn middle(&self) -> f64 {
        self.by_energy.midpoint(self.corrected)
    }
}

/// The periodic half-space of contact modulus one.
pub fn half_space(grid: Grid) -> Result<Westergaard<f64>> {
    Westergaard::new(grid, 1.0)
}

/// A solver to the tolerance of this example.
pub fn solver() -> Solver {
    Solver::new(Settings::default().tolerance(TOLERANCE))
}

/// The solution on a branch.
pub fn solve(problem: &mut Problem<f64>, control: Control, branch: Branch) -> Result<Solution<f64>> {
    let mut solver = solver();
    solver.settings.branch = Some(branch);
    solver.solve(problem, control)
}

/// The pull-off to a relative width of the bracket, after a preload or from flat.
pub fn pull_off(problem: &mut Problem<f64>, tolerance: f64, preload: Option<f64>) -> Result<FoundPullOff<f64>> {
    PullOff::default().tolerance(tolerance).preload(preload).find(&mut solver(), problem)
}

/// The stiffness between loads on both sides of a solution's load: pressure over mean gap, or over approach.
pub fn secant(problem: &mut Problem<f64>, solution: &Solution<f64>) -> Result<f64> {
    let report = &solution.report;
    let step = STEP * report.mean_contact_pressure;
    let mut far = |sign: f64| {
        let control = Control::MeanPressure(report.mean_pressure + sign * step);
        let found = solver().solve_with(problem, control, Start::From(&solution.gap), |_| ControlFlow::Continue(()))?;
        let moved = found.report.approach.unwrap_or(-found.report.mean_gap);
        Ok::<_, asperity::Error>(if found.report.status == Status::Converged { moved } else { f64::NAN })
    };
    Ok(2.0 * step / (far(1.0)? - far(-1.0)?))
}

/// The middle of the bracket of a search for the pull-off, as a mean pressure.
pub fn tension(found: &FoundPullOff<f64>) -> f64 {
    let borne = -found.solution.report.mean_pressure;
    found.lost.map_or(borne, |lost| borne.midpoint(lost))
}

/// The value to which a grid and a grid with half the nodes along the sides converge with the first order.
pub fn extrapolated(fine: f64, coarse: f64) -> f64 {
    2.0 * fine - coarse
}

/// Prints a title and the head of a table.
pub fn head(title: &str, columns: &[&str]) {
    println!("\n{title}\n");
    println!("| {} |", columns.join(" | "));
    println!("|{}", "---|".repeat(columns.len()));
}

/// Prints a row of a table.
pub fn row(cells: &[String]) {
    println!("| {} |", cells.join(" | "));
}

//! A trial step of a path, and the judgement by which it is taken.

use super::balance::Balance;
use super::course::Course;
use super::figures::Mode;
use crate::real::Real;
use crate::solver::{Solved, Status};
use crate::stability::Saddle;

/// A solve at the next target of a path.
pub(super) struct Trial<T: Real> {
    pub(super) target: f64,
    /// whether the step cannot be halved
    pub(super) smallest: bool,
    /// whether surfaces touched at new places on the way
    pub(super) touches: bool,
    pub(super) solved: Solved<T>,
    pub(super) balance: Balance,
    /// the saddle at which the solve ended
    pub(super) saddle: Option<Saddle>,
}

/// What follows from a trial.
pub(super) enum Judgement {
    /// The state is the next one on the path.
    Take,
    /// A shorter step is tried.
    Halve,
    /// The leg continues at given mean gaps, past a limit point of the load or before a bifurcation.
    Turn { limit_point: bool },
}

impl<T: Real> Trial<T> {
    pub(super) fn settled(&self) -> bool {
        self.solved.is_settled()
    }

    /// Whether the state is on the branch of the last one.
    pub(super) fn is_good(&self) -> bool {
        self.balance.balanced && self.settled()
    }

    fn is_jump(&self) -> bool {
        self.settled() && !self.is_good() && self.balance.located
    }

    /// Whether the state may be the next one, if it is stable.
    pub(super) fn may_be_taken(&self) -> bool {
        self.settled() && (self.is_good() || self.smallest || self.is_jump())
    }

    pub(super) fn judge(&self, course: &Course) -> Judgement {
        let good = self.is_good();
        let lost = good && self.saddle.is_some() && !course.on_saddle;
        if (!good && !self.is_jump() || lost) && !self.smallest {
            return Judgement::Halve;
        }
        let detached = self.solved.solution.report.status == Status::Detached;
        let ends = self.balance.jumped && !good || detached || lost;
        if ends && course.mode == Mode::Pressure { Judgement::Turn { limit_point: !lost } } else { Judgement::Take }
    }
}

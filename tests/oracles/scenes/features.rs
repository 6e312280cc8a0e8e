//! What scenes are drawn from.

use super::*;

/// What scenes are drawn from.
#[derive(Clone, Copy, Debug)]
pub struct Features {
    pub laws: &'static [Kind],
    pub constraints: &'static [Constraint],
    pub precisions: &'static [Precision],
    pub bodies: &'static [Body],
    /// whether some have absent nodes
    pub absent: bool,
    /// whether some have bodies in layers, the weak laws of stiff bodies, and no load
    pub more: bool,
}

impl Features {
    pub const ALL: Self = Self {
        laws: &[
            Kind::None,
            Kind::Exponential,
            Kind::MaugisDugdale,
            Kind::LennardJones,
            Kind::Morse,
            Kind::PowerLaw,
            Kind::Table,
            Kind::CutOff,
            Kind::Varying,
        ],
        constraints: &[Constraint::Hard, Constraint::Paper, Constraint::Penalty, Constraint::Uzawa, Constraint::None],
        precisions: &[Precision::Single, Precision::Double, Precision::Mixed],
        bodies: &[Body::Periodic, Body::Free],
        absent: true,
        more: false,
    };

    /// Hard walls in a periodic cell without adhesion: one solution, convex.
    pub const HARD: Self = Self {
        laws: &[Kind::None],
        constraints: &[Constraint::Hard],
        bodies: &[Body::Periodic],
        absent: false,
        ..Self::ALL
    };

    /// The law that has the range of the grid, on every body and at every wall.
    pub const JKR: Self = Self {
        laws: &[Kind::Jkr],
        constraints: &[Constraint::Hard, Constraint::Penalty, Constraint::Uzawa],
        ..Self::ALL
    };

    /// What [`Features::ALL`] lacks, besides what it has.
    pub const MORE: Self = Self {
        constraints: &[
            Constraint::Hard,
            Constraint::Hardness,
            Constraint::Penalty,
            Constraint::Uzawa,
            Constraint::Paper,
            Constraint::None,
        ],
        more: true,
        ..Self::ALL
    };

    /// The combinations that there are, as often as they are to be drawn: most of hard walls.
    pub(super) fn combinations(&self) -> Vec<(Kind, Constraint, Precision)> {
        let times = |law: Kind, constraint: Constraint| match (law, constraint) {
            (Kind::None, Constraint::Hard | Constraint::Hardness) => 8,
            (_, Constraint::Hard | Constraint::Hardness) => 3,
            (Kind::None, Constraint::None) => 0,
            (Kind::None, _) => 1,
            (_, Constraint::Paper) => 0,
            (Kind::LennardJones | Kind::Morse | Kind::CutOff | Kind::Varying, Constraint::None) => 2,
            (_, Constraint::None) => 0,
            _ => 1,
        };
        let pairs = self.constraints.iter().flat_map(|&constraint| self.laws.iter().map(move |&law| (law, constraint)));
        let repeated = pairs.flat_map(|pair| std::iter::repeat_n(pair, times(pair.0, pair.1)));
        let with = |(law, constraint)| self.precisions.iter().map(move |&precision| (law, constraint, precision));
        repeated.flat_map(with).collect()
    }
}

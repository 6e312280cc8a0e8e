//! The laws of scenes.

use super::*;

/// An adhesion law: of what kind, with a wall at its gap of rest or none.
#[derive(Clone, Debug)]
pub struct Law {
    pub kind: Kind,
    /// that which is cut off, or varies
    pub base: Kind,
    pub work: f64,
    pub range: f64,
    pub wall: bool,
    pub cut_off: Option<f64>,
    /// the works of adhesion over the work of adhesion of the law
    pub shares: Option<Array2<f64>>,
}

impl Law {
    pub fn is_none(&self) -> bool {
        self.kind == Kind::None
    }

    /// The law at a node as a function of the gap alone; it counts for the work of adhesion times [`Self::share`].
    pub fn of_gap<T: Real>(&self) -> Box<dyn AdhesionLaw<T>> {
        if self.base == Kind::Jkr {
            let compliance = (self.range / self.range_on(1.0)).powi(2);
            return Box::new(Jkr::new(self.work).unwrap().on_nodes(T::lit(compliance)).unwrap());
        }
        Self { shares: None, ..self.clone() }.boxed()
    }

    /// The range of the law with a range set by the grid, on nodes of this compliance.
    pub(super) fn range_on(&self, compliance: f64) -> f64 {
        let law: Arc<dyn AdhesionLaw<f64>> = Jkr::new(self.work).unwrap().on_nodes(compliance).unwrap();
        law.hints().range
    }

    pub fn share(&self, node: usize) -> f64 {
        self.shares.as_ref().map_or(1.0, |shares| shares.as_slice().expect("in rows")[node])
    }

    /// Whether it is zero beyond some gap.
    pub fn ends(&self) -> bool {
        self.cut_off.is_some() || matches!(self.base, Kind::MaugisDugdale | Kind::Table)
    }

    /// The gap at which the law alone holds the surfaces apart.
    pub fn rest(&self) -> f64 {
        if self.base == Kind::LennardJones && !self.wall { self.range } else { 0.0 }
    }

    pub fn boxed<T: Real>(&self) -> Box<dyn AdhesionLaw<T>> {
        let (w, range) = (self.work, self.range);
        match self.base {
            Kind::Exponential => self.changed(Exponential::new(w, range).unwrap()),
            Kind::MaugisDugdale => self.changed(MaugisDugdale::new(w, range).unwrap()),
            Kind::LennardJones if self.wall => self.changed(LennardJones::new(w, range).unwrap().cut()),
            Kind::LennardJones => self.changed(LennardJones::new(w, range).unwrap()),
            Kind::Morse => self.changed(Morse::new(w, range).unwrap()),
            Kind::Jkr => self.changed(Jkr::new(w).unwrap()),
            Kind::PowerLaw => self.changed(PowerLaw::new(w, range, 3.0).unwrap()),
            Kind::Table => {
                let points = [(0.0, 1.0), (0.5, 1.2), (1.0, 0.5), (2.0, 0.1), (3.0, 0.0)];
                let gaps = points.map(|(gap, _)| gap * range);
                self.changed(Tabulated::new(&gaps, &points.map(|(_, traction)| traction * w / (1.6 * range))).unwrap())
            }
            _ => Box::new(NoAdhesion),
        }
    }

    fn changed<T: Real, L>(&self, law: L) -> Box<dyn AdhesionLaw<T>>
    where
        L: AdhesionLaw<T> + AdhesionLaw<f64> + Clone + 'static,
    {
        let works = self.shares.as_ref().map(|shares| shares * AdhesionLaw::<f64>::hints(&law).work_of_adhesion);
        match (self.cut_off, works) {
            (None, None) => Box::new(law),
            (None, Some(works)) => Box::new(Varying::new(law, works.view()).unwrap()),
            (Some(end), None) => Box::new(CutOff::new(law, end).unwrap()),
            (Some(end), Some(works)) => Box::new(CutOff::new(Varying::new(law, works.view()).unwrap(), end).unwrap()),
        }
    }
}

/// A law of some range, as strong as the stiffness of waves of some nodes lets it be felt.
pub(super) fn law(
    random: &mut ChaCha8Rng,
    kind: Kind,
    constraint: Constraint,
    shape: (usize, usize),
    (range, stiff): (f64, f64),
) -> Law {
    let bases = match constraint {
        Constraint::None => &[Kind::LennardJones, Kind::Morse][..],
        _ => &Features::ALL.laws[1..7],
    };
    let base = match kind {
        Kind::CutOff | Kind::Varying => bases[random.random_range(0..bases.len())],
        kind => kind,
    };
    let work = (power(random, -2.0, 0.5) * range).powi(2) * stiff;
    let cut = kind == Kind::CutOff || kind == Kind::Varying && random.random_bool(0.3);
    let end = range * random.random_range(4.0..10.0);
    // all of it nowhere only with a wall
    let least: f64 = if constraint == Constraint::None { 0.05 } else { 0.0 };
    let patches = random.random_bool(0.3);
    let mut shares = Array2::from_shape_simple_fn(shape, || {
        let share: f64 = random.random_range(0.0..2.0);
        if patches { least.max(f64::from(u8::from(share > 1.0))) } else { least.max(share) }
    });
    shares[[0, 0]] = 1.0;
    let (cut_off, shares) = (cut.then_some(end), (kind == Kind::Varying).then_some(shares));
    Law { kind, base, work, range, wall: constraint != Constraint::None, cut_off, shares }
}

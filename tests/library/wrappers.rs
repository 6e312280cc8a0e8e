//! Laws that wrap other laws answer to every method of the trait.

use std::collections::BTreeSet;
use std::sync::{Arc, Mutex};

use asperity::adhesion::{CutOff, Varying, check_law};
use asperity::*;
use ndarray::Array2;

#[path = "../../examples/patches/law.rs"]
mod patches;

use patches::Patches;

const SHAPE: (usize, usize) = (6, 4);

/// A law that says everything, and keeps the names of the methods that it was asked by.
struct Spy {
    /// nothing for a law that is the same at every node
    shape: Option<(usize, usize)>,
    work: f64,
    asked: Mutex<BTreeSet<&'static str>>,
}

impl Spy {
    fn new(shape: Option<(usize, usize)>, work: f64) -> Self {
        Self { shape, work, asked: Mutex::default() }
    }

    fn asked(&self, name: &'static str) {
        self.asked.lock().unwrap().insert(name);
    }

    fn other(&self, work: f64) -> Option<Box<dyn AdhesionLaw<f64> + '_>> {
        Some(Box::new(Spy::new(self.shape, work)))
    }

    /// The values at the nodes from `first` on, of those of the strongest.
    fn fill(&self, first: usize, gaps: &[f64], values: &mut [f64], of: impl Fn(f64) -> f64) {
        for (node, (value, &gap)) in (first..).zip(values.iter_mut().zip(gaps)) {
            let share = if self.shape.is_some() { 1.0 / (1 + node) as f64 } else { 1.0 };
            *value = self.work * share * of((1.0 - gap).max(0.0));
        }
    }
}

impl AdhesionLaw<f64> for Spy {
    fn energy(&self, gap: f64) -> f64 {
        self.asked("energy");
        -self.work * (1.0 - gap).max(0.0).powi(3)
    }
    fn traction(&self, gap: f64) -> f64 {
        self.asked("traction");
        3.0 * self.work * (1.0 - gap).max(0.0).powi(2)
    }
    fn slope(&self, gap: f64) -> f64 {
        self.asked("slope");
        -6.0 * self.work * (1.0 - gap).max(0.0)
    }
    fn work_of_adhesion(&self) -> f64 {
        self.asked("work_of_adhesion");
        self.work
    }
    fn range(&self) -> f64 {
        self.asked("range");
        0.7
    }
    fn is_zero(&self) -> bool {
        self.asked("is_zero");
        true
    }
    fn is_concave(&self) -> bool {
        self.asked("is_concave");
        true
    }
    fn rest(&self) -> Option<f64> {
        self.asked("rest");
        Some(0.0)
    }
    fn shape(&self) -> Option<(usize, usize)> {
        self.asked("shape");
        self.shape
    }
    fn in_rows_of(&self, _: &Grid) -> Option<Box<dyn AdhesionLaw<f64> + '_>> {
        self.asked("in_rows_of");
        self.other(3.0)
    }
    fn coarsened(&self, stride: (usize, usize)) -> Option<Box<dyn AdhesionLaw<f64> + '_>> {
        self.asked("coarsened");
        self.other((stride.0 + 10 * stride.1) as f64)
    }
    fn smoothed(&self, compliance: f64) -> Option<Box<dyn AdhesionLaw<f64> + '_>> {
        self.asked("smoothed");
        self.other(self.work * (1.0 + compliance))
    }
    fn energies(&self, first: usize, gaps: &[f64], energies: &mut [f64]) {
        self.asked("energies");
        self.fill(first, gaps, energies, |x| -x.powi(3));
    }
    fn tractions(&self, first: usize, gaps: &[f64], tractions: &mut [f64]) {
        self.asked("tractions");
        self.fill(first, gaps, tractions, |x| 3.0 * x.powi(2));
    }
    fn slopes(&self, first: usize, gaps: &[f64], slopes: &mut [f64]) {
        self.asked("slopes");
        self.fill(first, gaps, slopes, |x| -6.0 * x);
    }
    fn energies_and_tractions(&self, first: usize, gaps: &[f64], energies: &mut [f64], tractions: &mut [f64]) {
        self.energies(first, gaps, energies);
        self.tractions(first, gaps, tractions);
        *self.asked.lock().unwrap() = BTreeSet::from(["energies_and_tractions"]);
    }
    fn tractions_and_slopes(&self, first: usize, gaps: &[f64], tractions: &mut [f64], slopes: &mut [f64]) {
        self.tractions(first, gaps, tractions);
        self.slopes(first, gaps, slopes);
        *self.asked.lock().unwrap() = BTreeSet::from(["tractions_and_slopes"]);
    }
}

const GAPS: [f64; 5] = [0.0, 0.2, 0.4, 0.9, 1.5];

fn nodes(of: impl Fn(&mut [f64], &mut [f64])) -> Vec<f64> {
    let (mut a, mut b) = ([0.0; 5], [0.0; 5]);
    of(&mut a, &mut b);
    [a, b].concat()
}

fn energies(law: Option<Box<dyn AdhesionLaw<f64> + '_>>) -> Vec<f64> {
    law.map_or(vec![], |law| nodes(|values, _| law.energies(2, &GAPS, values)))
}

/// A method by its name, and its answer.
type Method = (&'static str, fn(&dyn AdhesionLaw<f64>) -> Vec<f64>);

const METHODS: [Method; 17] = [
    ("energy", |law| vec![law.energy(0.3)]),
    ("traction", |law| vec![law.traction(0.3)]),
    ("slope", |law| vec![law.slope(0.3)]),
    ("work_of_adhesion", |law| vec![law.work_of_adhesion()]),
    ("range", |law| vec![law.range()]),
    ("is_zero", |law| vec![f64::from(law.is_zero())]),
    ("is_concave", |law| vec![f64::from(law.is_concave())]),
    ("rest", |law| law.rest().into_iter().collect()),
    ("shape", |law| law.shape().into_iter().flat_map(|(nx, ny)| [nx as f64, ny as f64]).collect()),
    ("in_rows_of", |law| energies(law.in_rows_of(&Grid::new(SHAPE, (1.0, 1.0)).unwrap()))),
    ("coarsened", |law| energies(law.coarsened((2, 1)))),
    ("smoothed", |law| energies(law.smoothed(0.25))),
    ("energies", |law| nodes(|a, _| law.energies(2, &GAPS, a))),
    ("tractions", |law| nodes(|a, _| law.tractions(2, &GAPS, a))),
    ("slopes", |law| nodes(|a, _| law.slopes(2, &GAPS, a))),
    ("energies_and_tractions", |law| nodes(|a, b| law.energies_and_tractions(2, &GAPS, a, b))),
    ("tractions_and_slopes", |law| nodes(|a, b| law.tractions_and_slopes(2, &GAPS, a, b))),
];

/// Compares the answers of a wrapper with those of the law within, but for the methods that are its own.
#[track_caller]
fn answers(spy: &Spy, wrapper: &dyn AdhesionLaw<f64>, own: &[&str]) {
    for (name, answer) in METHODS.into_iter().filter(|(name, _)| !own.contains(name)) {
        let expected = answer(spy);
        spy.asked.lock().unwrap().clear();
        let found = answer(wrapper);
        assert_eq!(found, expected, "{name}");
        assert!(spy.asked.lock().unwrap().contains(name), "{name} does not reach the law");
    }
}

#[test]
fn every_wrapper_answers_to_every_method() {
    let source = include_str!("../../src/adhesion.rs");
    let body = source.split("pub trait AdhesionLaw").nth(1).and_then(|rest| rest.split("\n}\n").next()).unwrap();
    let methods = body.lines().filter_map(|line| line.strip_prefix("    fn ")?.split('(').next());
    assert_eq!(methods.collect::<Vec<_>>(), METHODS.map(|(name, _)| name));

    let by_node = ["shape", "in_rows_of", "coarsened"];
    for spy in [Spy::new(None, 2.0), Spy::new(Some(SHAPE), 2.0)] {
        answers(&spy, &&spy, &[]);
        answers(&spy, &Box::new(&spy), &[]);
        answers(&spy, &Arc::new(&spy), &[]);
        // of a law that ends before it is cut off nothing changes; where its nodes differ not all of them need do so
        let cut = CutOff::new(&spy, 1.25).unwrap();
        let own: &[&str] = if spy.shape.is_some() { &["is_concave"] } else { &[] };
        answers(&spy, &cut, own);
    }
    let spy = Spy::new(None, 2.0);
    let varying = Varying::new(&spy, Array2::from_elem(SHAPE, 2.0).view()).unwrap();
    answers(&spy, &varying, &by_node);
    answers(&spy, &CutOff::new(&varying, 1.25).unwrap(), &["shape", "in_rows_of", "coarsened", "is_concave"]);
    let patches = Patches { law: &spy, shape: SHAPE, shares: vec![1.0; SHAPE.0 * SHAPE.1] };
    answers(&spy, &patches, &by_node);
    for law in [&varying as &dyn AdhesionLaw<f64>, &patches] {
        assert_eq!(law.shape(), Some(SHAPE));
        assert_eq!(law.coarsened((2, 3)).unwrap().shape(), Some((3, 2)));
    }
}

#[test]
fn every_wrapper_of_every_law_passes_the_check() {
    let (w, range) = (0.05, 2e-9);
    let works = Array2::from_shape_fn(SHAPE, |(ix, iy)| w * ((ix + 2 * iy) % 5) as f64 / 4.0);
    let dugdale = MaugisDugdale::new(w, range).unwrap();
    let table = Tabulated::new(&[0.0, 1e-9, 2e-9, 5e-9], &[20e6, 30e6, 5e6, 0.0]).unwrap();
    let laws: [Box<dyn AdhesionLaw<f64>>; 6] = [
        Box::new(dugdale),
        Box::new(Exponential::new(w, range).unwrap()),
        Box::new(LennardJones::new(w, range).unwrap().cut()),
        Box::new(Morse::new(w, range).unwrap()),
        Box::new(PowerLaw::new(w, range, 2.0).unwrap()),
        Box::new(table),
    ];
    for law in &laws {
        let shares = works.iter().map(|work| work / w).collect();
        let cut = CutOff::new(law, 2.5 * range).unwrap();
        let varying = Varying::new(law, works.view()).unwrap();
        let wrappers: [&dyn AdhesionLaw<f64>; 5] = [
            &cut,
            &varying,
            &CutOff::new(&varying, 2.5 * range).unwrap(),
            &Varying::new(&cut, works.view()).unwrap(),
            &Patches { law, shape: SHAPE, shares },
        ];
        wrappers.iter().for_each(|wrapper| check_law(wrapper, 4.0 * range).unwrap());
    }
    // a map of works cannot be given twice
    let varying = Varying::new(dugdale, works.view()).unwrap();
    let twice = Varying::new(CutOff::new(varying, 3.0 * range).unwrap(), works.view()).unwrap_err();
    assert!(twice.to_string().contains("give the law that the varying one is made of"), "{twice}");
}

#[test]
fn a_law_that_ends_before_it_is_cut_off_solves_as_itself() {
    // an edge of the adhesive zone stays where a start without smoothed jumps leaves it
    let grid = Grid::square(64, 1.0).unwrap();
    let surface = Surface::wave_2d(grid, 0.02, 2).unwrap();
    let law = MaugisDugdale::new(2e-4, 4e-3).unwrap();
    let gap = |law: &dyn AdhesionLaw<f64>| {
        let mut problem = Problem::new(&surface, Westergaard::new(grid, 1.0).unwrap(), law).unwrap();
        Solver::default().solve(&mut problem, Control::MeanGap(0.02)).unwrap().gap
    };
    let works = Array2::from_elem((64, 64), 2e-4);
    let exact = gap(&law);
    assert_eq!(gap(&CutOff::new(law, 4e-3).unwrap()), exact);
    assert_eq!(gap(&CutOff::new(Varying::new(law, works.view()).unwrap(), 0.01).unwrap()), exact);
    assert_eq!(gap(&Patches { law, shape: (64, 64), shares: vec![1.0; 64 * 64] }), exact);
}

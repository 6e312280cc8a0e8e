//! Every law and every wrapper of one keeps the contract of the trait, and wrappers answer to all of its methods.

use std::sync::{Arc, Mutex};

use asperity::adhesion::{CutOff, Discretisation, Hints, Values, Varying, check_law};
use asperity::*;
use ndarray::Array2;

#[path = "../../examples/patches/law.rs"]
mod patches;

use patches::Patches;

const SHAPE: (usize, usize) = (6, 4);

/// Works of adhesion that vary, up to w.
fn works(w: f64) -> Array2<f64> {
    Array2::from_shape_fn(SHAPE, |(ix, iy)| w * ((ix + 2 * iy) % 5) as f64 / 4.0)
}

/// A law at each node in turn.
fn in_turn<L>(laws: Vec<L>) -> Patches<L> {
    let of = (0..SHAPE.0 * SHAPE.1).map(|node| node / 2 % laws.len()).collect();
    Patches { laws, shape: SHAPE, of }
}

/// A law in either precision.
trait Both: AdhesionLaw<f64> + AdhesionLaw<f32> {}
impl<L: AdhesionLaw<f64> + AdhesionLaw<f32>> Both for L {}

/// Holds a law, what it is adapted to, and boxes and references of it to the contract.
fn conforms(law: &dyn Both, far: f64) {
    fn check<T: Real>(law: &dyn AdhesionLaw<T>, far: f64) {
        check_law(&law, far).unwrap();
        check_law(&Arc::new(law), far).unwrap();
        let boxed: Box<dyn AdhesionLaw<T> + '_> = Box::new(law);
        check_law(&boxed, far).unwrap();
        let hints = boxed.hints();
        let compliance = T::lit(0.2) * hints.range * hints.range / hints.work_of_adhesion;
        for to in [Discretisation::Smooth(compliance), Discretisation::Coarse(1, 3)] {
            if let Some(adapted) = boxed.adapted(to) {
                check_law(&adapted, far).unwrap();
            }
        }
    }
    check::<f64>(&law, far);
    check::<f32>(&law, far);
}

#[test]
fn every_law_and_every_wrapper_keeps_the_contract() {
    let (w, range, works) = (0.05, 2e-9, works(0.05));
    let (far, end) = (4.0 * range, 2.5 * range);
    conforms(&NoAdhesion, far);
    conforms(&Jkr::new(w).unwrap(), far);
    conforms(&CutOff::new(Jkr::new(w).unwrap(), end).unwrap(), far);
    conforms(&Varying::new(Jkr::new(w).unwrap(), works.view()).unwrap(), far);
    conforms(&LennardJones::new(w, range).unwrap(), far);
    conforms(&PowerLaw::van_der_waals(6e-20, 0.165e-9).unwrap(), far);
    /// A law, and what can be made of it and of one with half of its work of adhesion and twice its range.
    fn each<L: Both + Clone + 'static>(law: &L, other: &L, (far, end): (f64, f64), works: &Array2<f64>) {
        let cut = CutOff::new(law.clone(), end).unwrap();
        let varying = Varying::new(law.clone(), works.view()).unwrap();
        let patches = || in_turn(vec![law.clone(), other.clone()]);
        conforms(law, far);
        conforms(&cut, far);
        conforms(&varying, far);
        conforms(&CutOff::new(varying.clone(), end).unwrap(), far);
        conforms(&Varying::new(cut.clone(), works.view()).unwrap(), far);
        conforms(&patches(), far);
        conforms(&CutOff::new(patches(), end).unwrap(), far);
        conforms(&in_turn(vec![cut]), far);
    }
    macro_rules! each {
        ($make:expr) => {
            each(&$make(w, range).unwrap(), &$make(0.5 * w, 2.0 * range).unwrap(), (far, end), &works)
        };
    }
    each!(MaugisDugdale::new);
    each!(Exponential::new);
    each!(Morse::new);
    each!(|w, range| LennardJones::new(w, range).map(LennardJones::cut));
    each!(|w, range| PowerLaw::new(w, range, 2.0));
    each!(|w, range| PowerLaw::new(w, range, 3.5));
    each!(|w: f64, range: f64| {
        let (gaps, tractions) = ([0.0, 0.5, 1.0, 2.5], [0.8, 1.2, 0.2, 0.0]);
        Tabulated::new(&gaps.map(|gap| gap * range), &tractions.map(|traction| traction * w / range))
    });
    // a map of works cannot be given twice
    let varying = Varying::new(MaugisDugdale::new(w, range).unwrap(), works.view()).unwrap();
    let twice = Varying::new(CutOff::new(varying, end).unwrap(), works.view()).unwrap_err();
    assert!(twice.to_string().contains("give the law before it varies"), "{twice}");
}

/// A law that says everything, and keeps the name of the method that it was asked by last.
struct Spy {
    shape: Option<(usize, usize)>,
    asked: Mutex<&'static str>,
}

impl Spy {
    fn answer<R>(&self, name: &'static str, answer: R) -> R {
        *self.asked.lock().unwrap() = name;
        answer
    }
}

impl AdhesionLaw<f64> for Spy {
    fn energy(&self, gap: f64) -> f64 {
        self.answer("energy", -(1.0 - gap).max(0.0).powi(3))
    }
    fn traction(&self, gap: f64) -> f64 {
        self.answer("traction", 3.0 * (1.0 - gap).max(0.0).powi(2))
    }
    fn slope(&self, gap: f64) -> f64 {
        self.answer("slope", -6.0 * (1.0 - gap).max(0.0))
    }
    fn hints(&self) -> Hints<f64> {
        let mut hints = Hints::new(1.0, 0.7).with_rest(0.0).concave();
        (hints.zero, hints.shape) = (true, self.shape);
        self.answer("hints", hints)
    }
    fn evaluate(&self, first: usize, gaps: &[f64], values: Values<'_, f64>) {
        let of = |gap: f64| [-1.0, 3.0, -6.0].map(|factor| factor * (first + 1) as f64 * (1.0 - gap).max(0.0));
        values.set(gaps, of);
        self.answer("evaluate", ());
    }
    fn contact_shares(&self, first: usize, gaps: &[f64], shares: &mut [f64]) {
        shares.iter_mut().zip(gaps).for_each(|(share, gap)| *share = (first + 1) as f64 * gap);
        self.answer("contact_shares", ());
    }
    fn on_nodes(&self, compliance: f64) -> Option<Arc<dyn AdhesionLaw<f64>>> {
        let law = Exponential::new(1.0, compliance).unwrap();
        self.answer("on_nodes", Some(Arc::new(law)))
    }
    fn adapted(&self, to: Discretisation<f64>) -> Option<Arc<dyn AdhesionLaw<f64>>> {
        let shape = match to {
            Discretisation::Coarse(nx, ny) => self.shape.map(|shape| (shape.0 / nx, shape.1 / ny)),
            _ => self.shape,
        };
        self.answer("adapted", Some(Arc::new(Spy { shape, asked: Mutex::default() })))
    }
}

/// A method by its name, and its answer in words.
type Method = (&'static str, fn(&dyn AdhesionLaw<f64>) -> String);

const METHODS: [Method; 8] = [
    ("energy", |law| law.energy(0.3).to_string()),
    ("traction", |law| law.traction(0.3).to_string()),
    ("slope", |law| law.slope(0.3).to_string()),
    ("hints", |law| format!("{:?}", law.hints())),
    ("evaluate", |law| {
        let mut values = [[0.0; 5]; 3];
        let [energies, tractions, slopes] = values.each_mut().map(|values| Some(&mut values[..]));
        law.evaluate(2, &[0.0, 0.2, 0.4, 0.7, 0.9], Values { energies, tractions, slopes });
        format!("{values:?}")
    }),
    ("contact_shares", |law| {
        let mut shares = [0.0; 3];
        law.contact_shares(2, &[0.0, 0.4, 0.9], &mut shares);
        format!("{shares:?}")
    }),
    ("on_nodes", |law| format!("{:?}", law.on_nodes(0.3).map(|law| law.hints().work_of_adhesion))),
    ("adapted", |law| {
        let shape = |to| law.adapted(to).map(|law| law.hints().shape);
        format!("{:?} {:?}", shape(Discretisation::Coarse(2, 1)), shape(Discretisation::Smooth(0.25)))
    }),
];

#[test]
fn every_wrapper_answers_to_every_method() {
    let source = include_str!("../../src/adhesion.rs");
    let body = source.split("pub trait AdhesionLaw").nth(1).and_then(|rest| rest.split("\n}\n").next()).unwrap();
    let methods = body.lines().filter_map(|line| line.strip_prefix("    fn ")?.split('(').next());
    assert_eq!(methods.collect::<Vec<_>>(), METHODS.map(|(name, _)| name));

    let answers = |spy: &Spy, wrapper: &dyn AdhesionLaw<f64>, own: &str| {
        for (name, answer) in METHODS {
            let expected = answer(spy);
            *spy.asked.lock().unwrap() = "";
            let found = answer(wrapper);
            assert!(found == expected || own.contains(name), "{name}: {found} {expected}");
            assert_eq!(*spy.asked.lock().unwrap(), name, "{name} does not reach the law");
        }
    };
    let [uniform, spy] = [None, Some(SHAPE)].map(|shape| Arc::new(Spy { shape, asked: Mutex::default() }));
    for spy in [&uniform, &spy] {
        answers(spy, &&**spy, "");
        answers(spy, &Box::new(&**spy), "");
        answers(spy, spy, "");
    }
    // of a law that ends before it is cut off nothing changes; where its nodes differ not all of them need do so
    answers(&uniform, &CutOff::new(uniform.clone(), 1.25).unwrap(), "");
    answers(&spy, &CutOff::new(spy.clone(), 1.25).unwrap(), "hints");
    // a law that varies adds its shape
    let varying = Varying::new(uniform.clone(), Array2::ones(SHAPE).view()).unwrap();
    assert_eq!(varying.hints(), uniform.hints().with_shape(SHAPE));
    let coarse = varying.adapted(Discretisation::Coarse(2, 3)).unwrap();
    assert_eq!(coarse.hints(), uniform.hints().with_shape((3, 2)));
}

#[test]
fn a_law_that_ends_before_it_is_cut_off_solves_as_itself() {
    // an edge of the adhesive zone stays where a start without smoothed jumps leaves it
    let grid = Grid::square(64, 1.0).unwrap();
    let surface = Surface::wave_2d(grid, 0.02, 2).unwrap();
    let law = MaugisDugdale::new(2e-4, 4e-3).unwrap();
    let gap = |law: Box<dyn AdhesionLaw<f64>>| {
        let mut problem = Problem::new(&surface, Westergaard::new(grid, 1.0).unwrap(), law).unwrap();
        Solver::default().solve(&mut problem, Control::MeanGap(0.02)).unwrap().gap
    };
    let works = Array2::from_elem((64, 64), 2e-4);
    let exact = gap(Box::new(law));
    assert_eq!(gap(Box::new(CutOff::new(law, 4e-3).unwrap())), exact);
    assert_eq!(gap(Box::new(CutOff::new(Varying::new(law, works.view()).unwrap(), 0.01).unwrap())), exact);
    assert_eq!(gap(Box::new(Patches { laws: vec![law], shape: (64, 64), of: vec![0; 64 * 64] })), exact);
}

#[test]
fn ranges_that_vary_are_solved_as_each_of_them_on_its_own() {
    // ever so long along y, so that the halves meet each other by their mean displacement alone
    let (n, settings) = (64, Settings::default().tolerance(1e-8));
    let grid = Grid::new((n, n), (1.0, 32.0)).unwrap();
    let laws = [(4e-4, 8e-3), (1e-4, 4e-3)].map(|(w, range)| Exponential::new(w, range).unwrap());
    let patches = Patches { laws: laws.to_vec(), shape: (n, n), of: (0..n * n).map(|node| node % n / 32).collect() };
    check_law::<f64>(&patches, 0.05).unwrap();
    let surface = Surface::wave(grid, 0.02, 1).unwrap();
    let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), patches).unwrap();
    let solution = Solver::new(settings).solve(&mut problem, Control::MeanGap(0.017)).unwrap();
    assert_eq!(solution.report.status, Status::Converged);
    let line = Grid::line(n, 1.0).unwrap();
    let profile = Surface::wave(line, 0.02, 1).unwrap();
    for (column, law) in [n / 4, 3 * n / 4].into_iter().zip(laws) {
        let slice = solution.gap.column(column);
        let mut alone = Problem::new(&profile, Westergaard::<f64>::new(line, 1.0).unwrap(), law).unwrap();
        let single = Solver::new(settings).solve(&mut alone, Control::MeanGap(slice.mean().unwrap())).unwrap();
        let off = slice.iter().zip(&single.gap).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // variations along y over 16 wave lengths change the waves along x by the square of a sixteenth
        assert!(off < 4e-3 * 0.04, "column {column}: {off:e}");
    }
}

//! The account of random scenes.

use super::*;

/// The ends of the scenes of a combination.
#[derive(Default)]
pub(super) struct Tally {
    pub(super) ends: BTreeMap<End, usize>,
    pub(super) iterations: Vec<usize>,
}

impl Tally {
    pub(super) fn count(&self, ends: &[End]) -> usize {
        ends.iter().filter_map(|end| self.ends.get(end)).sum()
    }

    pub(super) fn all(&self) -> usize {
        self.count(&End::ALL)
    }

    /// Those that end solved, and those that end as well as rounding lets them.
    pub(super) fn good(&self) -> [usize; 2] {
        [self.count(&[End::Converged, End::Detached]), self.count(&[End::Converged, End::Detached, End::Floor])]
    }
}

/// How scenes ended, by constraint, law and precision, and what was found wrong.
#[derive(Default)]
pub(super) struct Account {
    tallies: BTreeMap<(Constraint, Kind, Precision), Tally>,
    wrong: Vec<String>,
    verdicts: [usize; 3],
    compared: Vec<f64>,
}

impl Account {
    pub(super) fn collect(seeds: std::ops::Range<u64>) -> Self {
        let mut account = Self::default();
        for seed in seeds {
            let scene = Scene::new(seed);
            match caught(&scene) {
                Err(wrong) => account.wrong.push(wrong),
                Ok(judged) => {
                    let key = (scene.constraint, scene.law.kind, scene.precision);
                    let tally = account.tallies.entry(key).or_default();
                    *tally.ends.entry(judged.end).or_default() += 1;
                    tally.iterations.push(judged.iterations);
                    account.compared.extend(judged.distance);
                    judged.verdicts.iter().for_each(|&verdict| account.verdicts[verdict as usize] += 1);
                }
            }
        }
        account
    }

    /// The combinations, laws, constraints and precisions with more bad ends than what is held lets expect, by three
    /// standard deviations and one.
    fn missed(&self) -> Vec<String> {
        let mut groups = BTreeMap::<String, [[f64; 2]; 2]>::new();
        for (&(constraint, law, precision), tally) in &self.tallies {
            let rates = ENDS.iter().find(|(c, l, _)| (*c, *l) == (constraint, law)).map_or([[1000; 2]; 3], |row| row.2);
            let alone = [format!("{constraint:?} as constraint"), format!("{law:?} as law"), format!("{precision:?}")];
            for name in alone.into_iter().chain([format!("{constraint:?}, {law:?}, {precision:?}")]) {
                let group = groups.entry(name).or_default();
                let all = tally.all();
                for ((count, good), rate) in group.iter_mut().zip(tally.good()).zip(rates[precision as usize]) {
                    count[0] += (all - good) as f64;
                    count[1] += all as f64 * (1.0 - 1e-3 * f64::from(rate));
                }
            }
        }
        let within = |[bad, expected]: [f64; 2]| bad <= expected + 3.0 * expected.sqrt() + 1.0;
        let missed = groups.into_iter().filter(|(_, counts)| !counts.iter().all(|&count| within(count)));
        missed
            .map(|(name, counts)| format!("{name}: not solved, and not at the floor: found and held {counts:.1?}"))
            .collect()
    }

    /// The rates that were found, as [`ENDS`] has them, and the ends.
    pub(super) fn print(&self) {
        let rate = |good: usize, all: usize| 1000 * good / all;
        let mut pairs: Vec<_> = self.tallies.keys().map(|(constraint, law, _)| (*constraint, *law)).collect();
        pairs.dedup();
        for (constraint, law) in pairs {
            let of = |precision| self.tallies.get(&(constraint, law, precision));
            let precisions = Features::ALL.precisions.iter();
            let rates = precisions.map(|&p| of(p).map_or([0; 2], |tally| tally.good().map(|n| rate(n, tally.all()))));
            println!("    (Constraint::{constraint:?}, Kind::{law:?}, {:?}),", rates.collect::<Vec<_>>());
        }
        println!("constraint law precision: scenes, {:?}; iterations: median, most", End::ALL);
        for ((constraint, law, precision), tally) in &self.tallies {
            let mut iterations = tally.iterations.clone();
            iterations.sort_unstable();
            let (median, most) = (iterations[iterations.len() / 2], iterations[iterations.len() - 1]);
            let ends = End::ALL.map(|end| tally.count(&[end]));
            println!("{constraint:?} {law:?} {precision:?}: {}, {ends:?}; {median}, {most}", tally.all());
        }
        let largest = self.compared.iter().copied().fold(0.0, f64::max);
        println!(
            "{} compared with an exact equilibrium, at most {largest:.2} of what is admitted",
            self.compared.len()
        );
        println!("verdicts: {:?} stable, unstable, undecided", self.verdicts);
    }

    pub(super) fn check(&self) {
        self.wrong.iter().take(100).for_each(|wrong| println!("{wrong}"));
        let missed = self.missed();
        missed.iter().for_each(|missed| println!("{missed}"));
        assert!(
            self.wrong.is_empty() && missed.is_empty(),
            "{} wrong, {} rates missed",
            self.wrong.len(),
            missed.len()
        );
    }
}

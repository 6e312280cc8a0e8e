//! The numbers of a state, by which a path that was interrupted goes on.

use super::{PLACES, State};
use crate::path::account::Account;
use crate::path::place::{Mode, Place};

impl State {
    /// The numbers of the state.
    pub(in crate::path) fn numbers(&self) -> Vec<f64> {
        let flag = |flag: bool| f64::from(u8::from(flag));
        let pair =
            |pair: Option<(f64, f64)>| [flag(pair.is_some()), pair.unwrap_or_default().0, pair.unwrap_or_default().1];
        let Account { work, dissipated, imbalance, range } = self.account;
        let mut numbers = vec![flag(self.solved), self.leg as f64, self.mode.code()];
        numbers.push(flag(self.on_saddle));
        numbers.extend([self.span.0, self.span.1, self.step]);
        numbers.extend(pair(self.pressures).into_iter().chain(pair(self.limit)));
        numbers.extend([work, dissipated, imbalance, range.0, range.1]);
        for places in [&self.places, &self.at] {
            numbers.push(places.len() as f64);
            numbers.extend(places.iter().flat_map(|p| [p.position, p.rest, p.gap, p.pressure, p.energy, p.contact]));
        }
        numbers
    }

    /// The state of the numbers of another one, on the same problem as `on`.
    pub(in crate::path) fn of_numbers(numbers: &[f64], on: Self) -> Option<Self> {
        let mut rest = numbers.iter().copied();
        let mut next = || rest.next();
        let (solved, leg, mode, on_saddle) = (next()? != 0.0, next()?, next()?, next()? != 0.0);
        let (span, step) = ((next()?, next()?), next()?);
        let mut pair = || Some((next()? != 0.0, (next()?, next()?)));
        let [pressures, limit] = [pair()?, pair()?].map(|(there, pair)| there.then_some(pair));
        let account = Account { work: next()?, dissipated: next()?, imbalance: next()?, range: (next()?, next()?) };
        let mut places = || -> Option<Vec<Place>> {
            let count = next()?;
            if !(0.0..=PLACES as f64).contains(&count) {
                return None;
            }
            (0..count as usize)
                .map(|_| {
                    let (position, rest) = (next()?, next()?);
                    let (gap, pressure, energy, contact) = (next()?, next()?, next()?, next()?);
                    Some(Place { position, rest, gap, pressure, energy, contact })
                })
                .collect()
        };
        let (places, at) = (places()?, places()?);
        let whole = leg >= 0.0 && leg.fract() == 0.0 && solved != places.is_empty();
        let (mode, free, area) = (Mode::of_code(mode), on.free, on.area);
        let state = Self {
            solved,
            leg: leg as usize,
            mode,
            free,
            area,
            span,
            step,
            pressures,
            limit,
            on_saddle,
            account,
            places,
            at,
        };
        (whole && rest.next().is_none()).then_some(state)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_state_comes_back_from_its_numbers() {
        let place = |x: f64| Place { position: x, rest: 2.0 * x, gap: x, pressure: -x, energy: x * x, contact: 0.5 };
        let state = State {
            solved: true,
            leg: 2,
            mode: Mode::Spring(0.3),
            free: true,
            area: 2.0,
            span: (0.1, 0.7),
            step: 1e-3,
            pressures: Some((0.2, 0.3)),
            limit: None,
            on_saddle: true,
            account: Account { work: 1.0, dissipated: 2.0, imbalance: -3.0, range: (4.0, 5.0) },
            places: vec![place(0.1), place(0.2), place(0.3)],
            at: vec![place(0.3)],
        };
        let numbers = state.numbers();
        let on = || State { free: true, area: 2.0, ..State::default() };
        assert_eq!(State::of_numbers(&numbers, on()).unwrap(), state);
        assert_eq!(State::of_numbers(&State::default().numbers(), State::default()).unwrap(), State::default());
        for length in 0..numbers.len() {
            assert_eq!(State::of_numbers(&numbers[..length], on()), None);
        }
        assert_eq!(State::of_numbers(&[numbers, vec![0.0]].concat(), on()), None);
    }
}

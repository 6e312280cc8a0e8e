//! The values of a state by their names, from which an interrupted path goes on.

use std::collections::BTreeMap;

use super::{Course, PLACES};
use crate::path::account::Account;
use crate::path::figures::{Figures, Mode};

impl Course {
    pub(in crate::path) fn values(&self) -> BTreeMap<String, Vec<f64>> {
        let flag = |flag: bool| vec![f64::from(u8::from(flag))];
        let pair = |pair: Option<(f64, f64)>| pair.map_or(Vec::new(), |(a, b)| vec![a, b]);
        let places = |places: &[Figures]| {
            places.iter().flat_map(|p| [p.position, p.rest, p.gap, p.pressure, p.energy, p.contact]).collect()
        };
        let Account { work, dissipated, imbalance, range } = self.account;
        let values = [
            ("solved", flag(self.solved)),
            ("leg", vec![self.leg as f64]),
            (
                "held",
                match self.mode {
                    Mode::Gap => vec![0.0],
                    Mode::Pressure => vec![1.0],
                    Mode::Spring(compliance) => vec![2.0, compliance],
                },
            ),
            ("span", pair(Some(self.span))),
            ("step", vec![self.step]),
            ("pressures", pair(self.pressures)),
            ("limit_point", pair(self.limit)),
            ("on_saddle", flag(self.on_saddle)),
            ("work", vec![work]),
            ("dissipated", vec![dissipated]),
            ("imbalance", vec![imbalance]),
            ("energies", pair(Some(range))),
            ("states", places(&self.places)),
            ("states_of_fields", places(&self.at)),
        ];
        values.into_iter().map(|(name, values)| (name.to_owned(), values)).collect()
    }

    pub(in crate::path) fn of_values(values: &BTreeMap<String, Vec<f64>>, on: Self) -> Option<Self> {
        let of = |name: &str| values.get(name).map(Vec::as_slice);
        let one = |name: &str| if let [value] = *of(name)? { Some(value) } else { None };
        let pair = |name: &str| match *of(name)? {
            [] => Some(None),
            [a, b] => Some(Some((a, b))),
            _ => None,
        };
        let places = |name: &str| -> Option<Vec<Figures>> {
            let (places, rest) = of(name)?.as_chunks();
            let place = |&[position, rest, gap, pressure, energy, contact]: &[f64; 6]| Figures {
                position,
                rest,
                gap,
                pressure,
                energy,
                contact,
            };
            (rest.is_empty() && places.len() <= PLACES).then(|| places.iter().map(place).collect())
        };
        let mode = match *of("held")? {
            [0.0] => Mode::Gap,
            [1.0] => Mode::Pressure,
            [2.0, compliance] => Mode::Spring(compliance),
            _ => return None,
        };
        let (leg, account) = (
            one("leg")?,
            Account {
                work: one("work")?,
                dissipated: one("dissipated")?,
                imbalance: one("imbalance")?,
                range: pair("energies")??,
            },
        );
        let state = Self {
            solved: one("solved")? != 0.0,
            leg: leg as usize,
            mode,
            free: on.free,
            area: on.area,
            span: pair("span")??,
            step: one("step")?,
            pressures: pair("pressures")?,
            limit: pair("limit_point")?,
            on_saddle: one("on_saddle")? != 0.0,
            account,
            places: places("states")?,
            at: places("states_of_fields")?,
        };
        (leg >= 0.0 && leg.fract() == 0.0 && state.solved != state.places.is_empty()).then_some(state)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_state_comes_back_from_its_values() {
        let place = |x: f64| Figures { position: x, rest: 2.0 * x, gap: x, pressure: -x, energy: x * x, contact: 0.5 };
        let state = Course {
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
        let values = state.values();
        let on = || Course { free: true, area: 2.0, ..Course::default() };
        assert_eq!(Course::of_values(&values, on()).unwrap(), state);
        assert_eq!(Course::of_values(&Course::default().values(), Course::default()).unwrap(), Course::default());
        for name in values.keys() {
            let (mut less, mut more) = (values.clone(), values.clone());
            less.remove(name);
            more.get_mut(name).unwrap().extend([0.5; 3]);
            assert_eq!((Course::of_values(&less, on()), Course::of_values(&more, on())), (None, None), "{name}");
        }
    }
}

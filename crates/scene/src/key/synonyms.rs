//! Synonyms and misspellings of names, and the names that they stand for.

/// Words for keys, with the keys that are meant; a command has one of these. A word stands for its plural as well.
pub const SYNONYMS: [(&str, &str); 30] = [
    ("pressure load stress normal-pressure applied-pressure nominal-pressure p", "mean-pressure mean-pressures"),
    ("force normal-load indentation-force f", "normal-force normal-forces"),
    ("gap separation distance", "mean-gap mean-gaps"),
    ("displacement indentation penetration depth", "approach approaches"),
    ("spring spring-stiffness cantilever machine-stiffness k", "spring-stiffness spring"),
    ("contact-area area fraction", "contact-fraction contact-fractions"),
    ("poisson poisson-ratio poissons-ratio nu young young-modulus youngs-modulus", "modulus"),
    ("second-surface other-surface counterbody counterface", "against"),
    ("offset translation slide", "shift"),
    ("elastic-modulus contact-modulus elasticity e e-star", "modulus"),
    ("adhesion adhesive adhesion-law potential interaction cohesive-law", "law"),
    ("surface-energy adhesion-energy energy gamma work w", "work-of-adhesion"),
    ("rho z0 d0 interaction-range interaction-length", "range"),
    ("hamaker-constant a", "hamaker"),
    ("cutoff cut-off-distance", "cut-off"),
    ("free periodic non-periodic boundary-condition bc", "boundary mirror"),
    ("input in file map topography surface profile i", "heights"),
    ("length side side-length size scan-size physical-size pixel-size", "lengths"),
    ("node pixel point resolution n", "size shape exponent"),
    ("output results folder dir directory o", "out"),
    ("tol rtol epsilon", "tolerance"),
    ("iterations maxiter max-iter", "max-iterations"),
    ("core cpu process worker job j", "threads jobs"),
    ("overwrite replace", "force"),
    ("picture image figure chart graph", "plot"),
    ("dtype float single double", "precision"),
    ("initial initial-gap guess start", "initial-gap start"),
    ("hurst-exponent h", "hurst"),
    ("rms roughness rq sq height", "rms-height"),
    ("slope rdq sdq", "rms-slope"),
];

/// The likeness of two names above which one may be the other misspelt: `ks` and `k-s` have 0.67, `ouput` and `out`
/// 0.6.
const ALIKE: f64 = 0.55;

/// The one of the `known` names that another name means.
pub fn meant<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let name = name.to_lowercase().replace('_', "-");
    let known: Vec<_> = known.into_iter().collect();
    let options = SYNONYMS.iter().filter(|(words, _)| words.split(' ').any(|word| is_same(word, &name)));
    let mut options = options.flat_map(|(_, options)| options.split(' '));
    let same = known.iter().find(|known| **known != name && is_same(known, &name)).copied();
    same.or_else(|| options.find_map(|option| known.iter().find(|known| **known == option).copied()))
}

/// The one of the `known` names that another name means, or is misspelt.
pub fn similar<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let known: Vec<_> = known.into_iter().collect();
    let likeness = |known: &&'a str| (strsim::normalized_damerau_levenshtein(name, known), *known);
    meant(name, known.iter().copied()).or_else(|| {
        let alike = known.iter().map(likeness).filter(|(likeness, _)| *likeness > ALIKE);
        alike.max_by(|(one, _), (other, _)| one.total_cmp(other)).map(|(_, known)| known)
    })
}

/// Whether two words are the same, but that one may be the plural of the other; letters have none.
pub fn is_same(one: &str, other: &str) -> bool {
    if one.len().min(other.len()) == 1 {
        return one == other;
    }
    let ends = [one.strip_prefix(other), other.strip_prefix(one)];
    ends.into_iter().flatten().any(|end| ["", "s", "es"].contains(&end))
}

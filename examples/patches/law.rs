//! A law in patches: another law, of which each node has a share.

use asperity::{AdhesionLaw, Real};

/// Energy, traction and slope of a law times a share of its own at each node; the largest share is one.
pub struct Patches<L> {
    pub law: L,
    pub shape: (usize, usize),
    /// of every node, in row-major order
    pub shares: Vec<f64>,
}

impl<L> Patches<L> {
    fn scale<T: Real>(&self, first: usize, values: &mut [T]) {
        let shares = &self.shares[first..];
        values.iter_mut().zip(shares).for_each(|(value, &share)| *value *= T::lit(share));
    }
}

impl<T: Real, L: AdhesionLaw<T>> AdhesionLaw<T> for Patches<L> {
    // the strongest node, for what asks for one gap alone
    fn energy(&self, gap: T) -> T {
        self.law.energy(gap)
    }
    fn traction(&self, gap: T) -> T {
        self.law.traction(gap)
    }
    fn slope(&self, gap: T) -> T {
        self.law.slope(gap)
    }
    fn work_of_adhesion(&self) -> T {
        self.law.work_of_adhesion()
    }
    fn range(&self) -> T {
        self.law.range()
    }
    fn is_zero(&self) -> bool {
        self.law.is_zero()
    }
    fn is_concave(&self) -> bool {
        self.law.is_concave()
    }
    fn rest(&self) -> Option<T> {
        // a node without a share does not repel
        self.law.rest().filter(|_| self.shares.iter().all(|&share| share > 0.0))
    }
    // the nodes that it is for, here and on coarser grids; every process has all of the shares
    fn shape(&self) -> Option<(usize, usize)> {
        Some(self.shape)
    }
    fn coarsened(&self, (nx, ny): (usize, usize)) -> Option<Box<dyn AdhesionLaw<T> + '_>> {
        let (rows, columns) = self.shape;
        let kept = (0..rows).step_by(nx).flat_map(|ix| (0..columns).step_by(ny).map(move |iy| ix * columns + iy));
        let shares = kept.map(|node| self.shares[node]).collect();
        let law: &dyn AdhesionLaw<T> = &self.law;
        Some(Box::new(Patches { law, shape: (rows.div_ceil(nx), columns.div_ceil(ny)), shares }))
    }
    // the jumps of the traction are largest where the law is strongest
    fn smoothed(&self, compliance: T) -> Option<Box<dyn AdhesionLaw<T> + '_>> {
        let law = self.law.smoothed(compliance)?;
        Some(Box::new(Patches { law, shape: self.shape, shares: self.shares.clone() }))
    }
    // every node, for the solve
    fn energies(&self, first: usize, gaps: &[T], energies: &mut [T]) {
        self.law.energies(first, gaps, energies);
        self.scale(first, energies);
    }
    fn tractions(&self, first: usize, gaps: &[T], tractions: &mut [T]) {
        self.law.tractions(first, gaps, tractions);
        self.scale(first, tractions);
    }
    fn slopes(&self, first: usize, gaps: &[T], slopes: &mut [T]) {
        self.law.slopes(first, gaps, slopes);
        self.scale(first, slopes);
    }
    fn energies_and_tractions(&self, first: usize, gaps: &[T], energies: &mut [T], tractions: &mut [T]) {
        self.law.energies_and_tractions(first, gaps, energies, tractions);
        self.scale(first, energies);
        self.scale(first, tractions);
    }
    fn tractions_and_slopes(&self, first: usize, gaps: &[T], tractions: &mut [T], slopes: &mut [T]) {
        self.law.tractions_and_slopes(first, gaps, tractions, slopes);
        self.scale(first, tractions);
        self.scale(first, slopes);
    }
}

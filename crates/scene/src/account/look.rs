//! The look at the fields of a solution, which finds the numbers of its account that the fields have.

use asperity::contact::ContactStatistics;
use asperity::{Real, Result, Solution};
use ndarray::ArrayView2;

use crate::account::{Account, Answer, Inputs, Sight, missing_error};
use crate::key::{Adhesion, Notice};

impl<T: Real> Answer<T> {
    /// The account of the solve by a command; [`Sight::look`] adds the keys that follow from the fields.
    ///
    /// # Errors
    /// [`Error::Shape`](asperity::Error::Shape) if the solution is not one of the whole of an original.
    pub fn account(
        &self,
        command: &'static str,
        inputs: &Inputs,
        strongest: Option<(usize, usize)>,
        warnings: Vec<Notice>,
    ) -> Result<Account> {
        let (original, part) = (self.sight.original, self.part()?);
        let (grid, report) = (&part.grid, &part.report);
        let share = original.map_or(1.0, |original| original.share());
        let inputs = Inputs {
            solved_shape: original.map(|_| self.solution.grid.shape()),
            shape: grid.shape(),
            lengths: grid.lengths(),
            tolerance: report.tolerance,
            adhesion: Adhesion {
                range: inputs.adhesion.range.or(report.range),
                hardness: report.plastic.map(|plastic| plastic.hardness),
                ..inputs.adhesion.clone()
            },
            ..inputs.clone()
        };
        let mut account = Account::record(command, self, report, share, inputs, strongest, warnings);
        self.sight.tell(&mut account);
        Ok(account)
    }
}

impl<T: Real> Sight<T> {
    /// Looks at the fields of the solution, as [`Sight::look`].
    ///
    /// # Errors
    /// Those of [`Sight::look`].
    pub fn look_at(&mut self, account: &mut Account, solution: &Solution<T>) -> Result<ContactStatistics> {
        let Solution { gap, pressure, contact_pressure, .. } = solution;
        self.look(account, [gap.view(), pressure.view(), contact_pressure.view()])
    }

    /// Looks at gap, pressure and contact pressure: fills in the keys of the account that are found of them, and
    /// returns the statistics of the contact. All processes that share the grid have to look.
    ///
    /// # Errors
    /// [`Error::Shape`](asperity::Error::Shape) if a field does not have the shape of the grid.
    pub fn look(&mut self, account: &mut Account, fields: [ArrayView2<'_, T>; 3]) -> Result<ContactStatistics> {
        let (found, pressures) = self.seen(fields)?;
        if let Some((waves, levels)) = self.open.take() {
            self.estimate(&levels, waves.nodes(self.report.boundary));
        }
        self.tell(account);
        account.corrected_contact_fraction = found.corrected_contact_fraction;
        account.perimeter = found.perimeter;
        account.repulsive_fraction = found.repulsive_fraction;
        account.attractive_fraction = found.attractive_fraction;
        account.patches = Some(found.patches.clone());
        account.min_pressure = pressures.least;
        account.max_pressure = pressures.greatest;
        account.pressure_residue = pressures.residue;
        Ok(found)
    }

    /// Puts the errors that are known into an account.
    fn tell(&self, account: &mut Account) {
        if let Some((errors, nodes_per_wave)) = self.errors {
            (account.grid_error, account.nodes_per_wave) = (Some(errors), nodes_per_wave);
            let is_told = errors.in_words(account.accuracy.map(|reached| reached.of)).is_some();
            account.grid_error_reason = (!is_told || errors.area.is_none()).then(|| missing_error(account));
        }
    }
}

//! The files that a solve leaves in its folder.

use asperity::Solution;
use asperity::contact::PressureDistribution;
use asperity_maps::io::{OutputFolder, write_npz, write_vti};
use asperity_scene::output::write_text;
use asperity_scene::{Account, Scalar, Units, csv, gap_to_write};

use super::others::Named;
use super::{DISTRIBUTION, FIELDS, Format, Job, NPZ, PICTURES, VTI};
use crate::pictures::{self, FormatKeys, MapColours, PaperOptions};
use crate::results::write_report;

impl Job<'_> {
    /// Writes the files but for fields, where each process writes its rows; files of the `whole` solution, where there
    /// is one. Returns the load beyond the colours of the picture of the pressure, in words.
    pub(super) fn write<T: Scalar>(
        &self,
        folder: &OutputFolder,
        units: &Units,
        whole: Option<&Solution<T>>,
        beside: &[Named],
        account: &Account,
    ) -> asperity::Result<Option<String>> {
        let path = |name: &str| folder.path(name);
        write_report(folder, account)?;
        let Some(whole) = whole else { return Ok(None) };
        let (shown, solution) = (self.part.grid().alone(), &*self.part.of_solution(whole)?);
        let gap = gap_to_write(solution);
        let fields = [&*gap, &solution.pressure, &solution.contact_pressure];
        let beside = beside.iter().map(|(name, field)| Ok((*name, self.part.of_field(field.mapv(T::lit))?)));
        let beside = beside.collect::<asperity::Result<Vec<_>>>()?;
        let named = FIELDS.into_iter().zip(fields).chain(beside.iter().map(|(name, field)| (*name, field)));
        let named: Vec<_> = named.map(|(name, field)| (name.trim_end_matches(".npy"), field.view())).collect();
        if self.options.writes(Format::Npz) {
            write_npz(path(NPZ), &shown, &named)?;
        }
        if self.options.writes(Format::Vti) {
            write_vti(path(VTI), &shown, &named)?;
        }
        if let Some(bins) = self.options.distribution {
            let found = PressureDistribution::of_contact_pressure(solution, bins)?;
            let names = units.columns(&["from_pressure", "to_pressure", "density"], "", false);
            write_text(&path(DISTRIBUTION), &csv::density(names, &found.edges, &found.density))?;
        }
        if !self.pictures {
            return Ok(None);
        }
        let given = self.problem.case.given();
        let (FormatKeys { picture_format }, colours) = (given.keys(), given.keys::<MapColours>());
        let paper = given.keys::<PaperOptions>().paper();
        let [contact_name, pressure_name] = PICTURES.map(|name| path(&picture_format.file(name)));
        let mut regions = self.part.of_field(whole.regions())?.mapv(f64::from);
        let depth = solution.plastic_depth.as_ref();
        depth.into_iter().for_each(|depth| pictures::mark_yielded(&mut regions, depth.view()));
        let meet = self.part.sides_meet(whole);
        pictures::draw_contact(shown, "Contact", units, &regions, colours.clusters(meet), paper)?
            .write(contact_name)?;
        let pressure = pictures::pressure_to_draw(solution, self.problem.case.scene().adhesion.adheres());
        let picture = pictures::draw_pressure(shown, ("Pressure", ""), units, pressure, colours.limits(), paper)?;
        picture.write(pressure_name)?;
        Ok(picture.load_beyond().map(str::to_owned))
    }
}

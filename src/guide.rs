//! The guide: the physics next to the code, how-tos, and the construction of the crate.
//!
//! | page | contents |
//! |---|---|
//! | [`tour`] | gap, pressure, balance, energy, adhesion, grid and certificate, each with its line of code |
//! | [`laws`] | the choice of an adhesion law, laws that repel, and laws that vary over the surface |
//! | [`own_law`] | an adhesion law of your own |
//! | [`own_operator`] | layers, coatings, and an operator of your own |
//! | [`own_constraint`] | a constraint of your own that keeps the surfaces apart |
//! | [`boundary`] | a periodic cell or a free half-space, absent nodes; forces, approaches and springs |
//! | [`branches`] | loading and unloading with adhesion: jumps, limit points, loss of symmetry |
//! | [`choosing`] | grid, tolerance and precision for the accuracy you want; rounding and extreme input |
//! | [`performance`] | the cost of a solve: applications, nested grids, time, memory, threads |
//! | [`comparison`] | projection, penalty and Uzawa side by side, at equal error |
//! | [`paper_checked`] | the paper's misprints |
//! | [`cluster`] | job scripts for studies, and solves on several processes by MPI |
//! | [`driver`] | the energy, its minimisation, the certificate, one iteration step by step, and every constant in it |
//! | [`constants`] | the constants of all other rooms, and what fails without each |
//! | [`architecture`] | the layers of the crate, the way of the data, and places for new parts |
//!
//! The code on these pages is run by the tests.

/// A page from the file of its name, with the look of all pages.
macro_rules! page {
    ($name:ident) => {
        #[doc = include_str!(concat!("guide/", stringify!($name), ".md"))]
        #[doc = include_str!("pages.html")]
        pub mod $name {}
    };
}
page!(tour);
page!(laws);
page!(own_law);
page!(own_operator);
page!(own_constraint);
page!(boundary);
page!(branches);
page!(choosing);
page!(performance);
page!(comparison);
page!(paper_checked);
page!(cluster);
page!(driver);
page!(constants);
page!(architecture);

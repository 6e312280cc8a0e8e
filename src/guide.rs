//! The guide: the physics beside the code, how-tos, the tool, and the construction of the crate.
//!
//! | page | contents |
//! |---|---|
//! | [`tour`] | gap, pressure, balance, energy, adhesion, grid and certificate, each with its line of code |
//! | [`laws`] | which adhesion law for what, laws that repel, and laws that vary over the surface |
//! | [`own_law`] | an adhesion law of your own |
//! | [`own_operator`] | an elastic operator of your own: a layer of finite thickness |
//! | [`own_constraint`] | a way of your own to keep the surfaces apart |
//! | [`boundary`] | a periodic cell or a free half-space, absent nodes; forces, approaches and springs |
//! | [`branches`] | loading and unloading with adhesion: jumps, limit points, loss of symmetry |
//! | [`python`] | the Python package, and files for numpy |
//! | [`choosing`] | grid, tolerance and precision for the accuracy you want; rounding and extreme input |
//! | [`performance`] | the cost of a solve: applications, nested grids, time, memory, threads |
//! | [`paper_checked`] | the paper's misprints; penalty and Uzawa beside projection |
//! | [`tool`] | the command-line tool: scenes, studies, the keys of its reports, exit codes |
//! | [`cluster`] | job scripts for studies, and solves on several processes by MPI |
//! | [`driver`] | what the solver minimises, its certificate, one iteration step by step, and every constant in it |
//! | [`architecture`] | the layers of the crate, the data's way, and places for new parts |
//!
//! The code on these pages is run by the tests.

/// A page from the file of its name, and the style of its equations.
macro_rules! page {
    ($name:ident) => {
        #[doc = include_str!(concat!("guide/", stringify!($name), ".md"))]
        #[doc = include_str!("equations.html")]
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
page!(python);
page!(choosing);
page!(performance);
page!(paper_checked);
page!(tool);
page!(cluster);
page!(driver);
page!(architecture);

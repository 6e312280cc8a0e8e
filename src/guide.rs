//! From the physics to the code, how to do this and that, and how the crate is built.
//!
//! | page | what for |
//! |---|---|
//! | [`tour`] | the whole way once: gap, pressure, balance, energy, adhesion, grid, certificate, each with its line of code |
//! | [`laws`] | which adhesion law for what, laws that repel, and laws that vary over the surface |
//! | [`own_law`] | an adhesion law of your own |
//! | [`own_operator`] | an elastic operator of your own: a layer of finite thickness |
//! | [`own_constraint`] | a way of your own to keep the surfaces apart |
//! | [`boundary`] | a periodic cell or a free half-space, absent nodes; forces, approaches and springs |
//! | [`branches`] | loading and unloading with adhesion: jumps, limit points, stability |
//! | [`python`] | from Python: the package, and files |
//! | [`choosing`] | resolution, tolerance and precision for the accuracy you want |
//! | [`performance`] | how fast: applications, times, memory, beside other programs |
//! | [`paper_checked`] | the paper, its misprints, and its figures beside ours |
//! | [`tool`] | the command-line tool: scenes, studies, the keys of its reports, exit codes |
//! | [`cluster`] | job scripts for studies on many machines |
//! | [`driver`] | what the solver minimises, its certificate, one iteration step by step, and every constant in it |
//! | [`architecture`] | the layers of the crate, what may use what, and the data's way through one iteration |
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
#[cfg(feature = "io")]
page!(python);
page!(choosing);
page!(performance);
page!(paper_checked);
page!(tool);
page!(cluster);
page!(driver);
page!(architecture);

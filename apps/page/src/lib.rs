//! Pages that show a scene in a browser, each in one HTML file that needs no other file and no network.
//!
//! A [`View`] collects what a page shows. [`View::html`] puts it as JSON into a template with a script
//! (`assets/viewer.js`, made of the folder `web`), which draws it with three.js. A [`Sheet`] is the report of a comparison on
//! paper, as a PNG or a PDF file.
#![forbid(unsafe_code)]

mod colours;
mod decimate;
mod deviations;
mod frame;
mod packed;
mod sheet;
pub mod template;
mod view;

pub use colours::{band_colour, diverging_colour};
pub use deviations::{Deviations, ObjectDeviations, Verdict};
pub use sheet::Sheet;
pub use view::{Level, Measure, Moved, UpAxis, View};

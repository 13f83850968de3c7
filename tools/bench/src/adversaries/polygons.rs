//! Files of polygons that take as long to triangulate as a file may make it.

use crate::rounds::thread_seconds;
use p2m_cli::harness::Table;
use p2m_mixed::{MAX_CORNERS, Reason, read_obj};
use p2m_testkit::scenes::square_spiral;
use std::fmt::Write as _;

/// The numbers of polygons in the files. The last file exceeds the budget.
const COUNTS: [usize; 3] = [1, 16, 17];

/// Returns the table of files, and whether each was read or refused as it should be.
pub(crate) fn table() -> (Table, bool) {
    let corners = square_spiral(MAX_CORNERS as i64 / 2 - 1);
    let mut vertices = String::new();
    // Writing to a string does not fail.
    for [x, y] in &corners {
        let _ = writeln!(vertices, "v {x} {y} 0");
    }
    let references: String = (1..=corners.len()).map(|i| format!(" {i}")).collect();
    let mut table = Table::new(["polygons", "corners of each", "MB", "read in s", "outcome"]);
    let mut good = true;
    for count in COUNTS {
        let file = format!("{vertices}{}", format!("f{references}\n").repeat(count));
        let (read, seconds) = thread_seconds(|| read_obj(file.as_bytes(), "spirals"));
        let is_last = count == COUNTS[COUNTS.len() - 1];
        let outcome = match read {
            Ok(scene) => format!("{} triangles", scene.soup.triangles().len()),
            Err(error) => {
                good &= is_last && matches!(error.reason, Reason::PolygonsTooLarge { .. });
                "refused".to_owned()
            }
        };
        good &= is_last == (outcome == "refused");
        let megabytes = format!("{:.1}", file.len() as f64 / 1e6);
        table.push(vec![count.to_string(), corners.len().to_string(), megabytes, format!("{seconds:.1}"), outcome]);
    }
    (table, good)
}

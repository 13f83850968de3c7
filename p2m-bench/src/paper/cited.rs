//! The figures of the paper \[Zong2023\], measured on its own machine, models and libraries. Values that are derived
//! from these, such as ratios and microseconds per face, are marked as such on the page.

use p2m_tradeoff::Table;

fn table(head: &[&str], rows: &[&[&str]]) -> String {
    let mut table = Table::new(head.iter().copied());
    rows.iter().for_each(|row| table.push(row.iter().map(|cell| (*cell).to_owned()).collect()));
    table.to_string()
}

pub(super) fn table_1() -> String {
    table(
        &["cited", "faces", "mean (edges + faces)", "by volume", "most", "tested, mean", "tested, most"],
        &[
            &["Camel", "19510", "18.0 + 26.3", "15.0 + 17.2", "105 + 130", "5.5 + 2.7", "12 + 12"],
            &["Armadillo", "99976", "19.0 + 23.6", "17.1 + 20.7", "81 + 91", "4.7 + 1.9", "13 + 13"],
            &["Sponza", "262196", "21.4 + 26.8", "34.8 + 29.4", "296 + 168", "0.4 + 0.1", "23 + 28"],
            &["Lucy", "525814", "18.3 + 23.7", "23.1 + 22.6", "346 + 232", "4.3 + 1.6", "14 + 9"],
            &["Dragon", "1499852", "19.2 + 21.7", "16.6 + 19.2", "434 + 425", "5.1 + 2.0", "13 + 13"],
        ],
    )
}

pub(super) fn table_2() -> String {
    table(
        &["cited, ms", "KD-tree", "Voronoi diagram", "interception", "R-trees", "us a face"],
        &[
            &["Camel", "1.9 (0.2 %)", "105.4 (10.6 %)", "854.2 (85.7 %)", "17.1 (1.7 %)", "50.2"],
            &["Armadillo", "9.4 (0.2 %)", "718.8 (15.0 %)", "3847.5 (80.4 %)", "65.3 (1.4 %)", "46.4"],
            &["Sponza", "24.9 (0.2 %)", "1936.2 (12.3 %)", "13245.3 (84.3 %)", "232.1 (1.5 %)", "58.9"],
            &["Lucy", "53.1 (0.2 %)", "4100.0 (16.6 %)", "19436.6 (78.9 %)", "413.2 (1.7 %)", "45.6"],
            &["Dragon", "154.5 (0.2 %)", "12163.0 (12.6 %)", "80596.8 (83.7 %)", "1093.9 (1.1 %)", "62.7"],
        ],
    )
}

pub(super) fn table_3() -> String {
    table(
        &["cited, us a query", "PQP", "FCPW", "P2M, no R-trees", "P2M", "PQP / P2M", "FCPW / P2M", "gain of R-trees"],
        &[
            &["Camel", "7.47", "3.64", "1.43", "1.28", "5.8", "2.8", "1.12"],
            &["Armadillo", "9.64", "5.43", "2.45", "2.19", "4.4", "2.5", "1.11"],
            &["Sponza", "7.69", "0.79", "0.57", "0.41", "18.8", "1.9", "1.36"],
            &["Lucy", "11.84", "5.43", "2.44", "2.13", "5.6", "2.5", "1.14"],
            &["Dragon", "13.83", "7.56", "3.54", "3.34", "4.1", "2.3", "1.06"],
            &["#378036", "37.27", "20.04", "15.77", "7.60", "4.9", "2.6", "2.07"],
            &["#69078", "9.45", "6.79", "60.54", "3.43", "2.8", "2.0", "17.66"],
            &["#82324", "5.18", "1.12", "13.43", "0.54", "9.6", "2.1", "25.06"],
            &["#1472696", "6.94", "0.51", "30.51", "0.47", "14.8", "1.1", "64.97"],
            &["#236143", "5.61", "0.79", "37.51", "0.37", "15.2", "2.1", "100.75"],
        ],
    )
}

pub(super) fn table_4() -> String {
    table(
        &["cited (bad, good), us", "quality", "bad triangles", "PQP", "FCPW", "P2M"],
        &[
            &["first", "0.387, 0.755", "33.0 %, 0.1 %", "13.12, 9.41", "6.14, 3.68", "1.61, 1.31"],
            &["second", "0.344, 0.603", "44.5 %, 7.0 %", "15.20, 6.98", "4.44, 3.52", "1.42, 1.18"],
            &["third", "0.598, 0.763", "7.5 %, 0.5 %", "6.50, 6.52", "2.16, 2.02", "0.66, 0.65"],
            &["fourth", "0.061, 0.704", "87.8 %, 1.3 %", "7.53, 7.21", "0.76, 0.83", "0.31, 0.31"],
            &["fifth", "0.286, 0.756", "59.2 %, 3.3 %", "15.98, 8.66", "3.68, 5.22", "1.05, 1.95"],
            &["sixth", "0.292, 0.621", "58.4 %, 3.2 %", "24.96, 15.02", "11.24, 5.54", "2.72, 1.66"],
        ],
    )
}

/// The number of faces of the paper's Dragon.
pub(super) const DRAGON: f64 = 1_499_852.0;
/// Seconds that the P2M index of the Dragon takes to build.
pub(super) const BUILD: f64 = 137.4;
/// Seconds that the trees of PQP and FCPW take to build over the Dragon.
pub(super) const BUILD_OF_OTHERS: [f64; 2] = [4.0, 1.9];
/// Microseconds to locate the Voronoi cell of a query in the Dragon, by Section 5.3 of the paper.
pub(super) const LOCATE: f64 = 2.83;
/// Microseconds of a query of the Dragon in all, by Section 5.3 of the paper.
pub(super) const QUERY: f64 = 2.83 + 0.39;
/// Bytes of the index of the Dragon.
pub(super) const BYTES: f64 = 1.78e9;
/// The mean and the maximum length of the Dragon's lists, where edges and faces count as one.
pub(super) const LISTS: [f64; 2] = [41.0, 782.0];

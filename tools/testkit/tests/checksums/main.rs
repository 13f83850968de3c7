//! Checks that answers have the same bits on every processor, by comparing checksums with `checksums.txt`.
//!
//! `cargo test --release --package p2m-testkit --test checksums` computes the checksums on a machine, with every
//! instruction set of its processor, and compares them with the file. `P2M_BLESS=1` writes the file, and the saved
//! indexes beside it, which every machine then loads. `cargo xtask arm` runs this program for ARM, and `cargo xtask
//! wasm` as a module in Node.
//!
//! A row of the file is a scene, a scalar and a question. All backends answer it, both as built and as loaded, and have
//! to produce the checksum of the row. Scenes and queries are made by operations that are rounded to nearest
//! everywhere, or by generators that promise the same scene on every machine.

mod answers;
mod scenes;

use p2m::core::Isa;
use p2m_testkit::compiled;
use std::fmt::Write;

/// The file with the checksums. It is compiled in, as the saved indexes are, for machines without files.
const FILE: &str = include_str!("checksums.txt");
/// The names and the bytes of saved indexes of the smallest scene.
const SAVED: [(&str, &[u8]); 5] = [
    ("aabb.p2m", include_bytes!("aabb.p2m")),
    ("kdop-6.p2m", include_bytes!("kdop-6.p2m")),
    ("kdop-14.p2m", include_bytes!("kdop-14.p2m")),
    ("octree.p2m", include_bytes!("octree.p2m")),
    ("p2m.p2m", include_bytes!("p2m.p2m")),
];
/// The folder of these files.
#[cfg(not(target_family = "wasm"))]
const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/checksums");

/// The least number of checksums per row. WebAssembly, which has one kind of lanes, has about as many.
const MIN_CHECKSUMS_PER_ROW: usize = 10;

/// The checksums of all questions, and the answers that differ between backends.
#[derive(Default)]
struct Table {
    rows: Vec<(String, u64)>,
    faults: Vec<String>,
    /// The number of checksums that were computed for all rows.
    computed: usize,
}

impl Table {
    /// Adds the checksum of the answers of one backend, named `by`, to a question.
    fn add(&mut self, question: &str, by: &str, checksum: u64) {
        self.computed += 1;
        match self.rows.iter().find(|(name, _)| name == question) {
            Some((_, first)) if *first == checksum => {}
            Some(_) => self.faults.push(format!("{question}: {by} answers otherwise than the first backend")),
            None => self.rows.push((question.to_owned(), checksum)),
        }
    }

    fn text(&self) -> String {
        let mut text = String::from("# Checksums of answers, which main.rs of this folder writes and compares.\n");
        for (question, checksum) in &self.rows {
            let _ = writeln!(text, "{checksum:016x} {question}");
        }
        text
    }

    /// Reports the rows that differ from those of the file as faults.
    fn compare(&mut self) {
        let text = self.text();

        let [found, expected] = [&text, FILE].map(|text| text.lines().skip(1).collect::<Vec<_>>());
        for line in found.iter().filter(|line| !expected.contains(line)) {
            self.faults.push(format!("not in checksums.txt: {line}"));
        }
        for line in expected.iter().filter(|line| !found.contains(line)) {
            self.faults.push(format!("not found here:       {line}"));
        }
        // Several indexes with every kind of lanes answer each question.
        if self.computed < MIN_CHECKSUMS_PER_ROW * self.rows.len() {
            self.faults.push("most indexes were not asked".to_owned());
        }
    }

    /// Returns the text that a user reports.
    fn report(&self) -> String {
        let sets: Vec<&str> = Isa::available().into_iter().map(Isa::name).collect();
        let machine = format!("{}, {}; lanes: {}", compiled::TARGET, compiled::RUSTC, sets.join(", "));
        let counts = format!("{} checksums of {} rows", self.computed, self.rows.len());
        if self.faults.is_empty() {
            return format!("{machine}\n{counts}: all are those of checksums.txt");
        }
        format!("{machine}\n{counts}; wrong:\n  {}", self.faults.join("\n  "))
    }
}

/// Computes all checksums.
///
/// `exchange` gets the name and the bytes of each saved index of the smallest scene, and returns the bytes to load in
/// their place.
fn table(exchange: impl FnMut(&str, Vec<u8>) -> Vec<u8>) -> Table {
    let mut table = Table::default();
    answers::of_single_primitives(&mut table);
    answers::of_scenes(&mut table, exchange);
    table
}

/// Computes all checksums with the saved indexes beside the file, and compares them with the file.
fn compared_table() -> Table {
    let mut table = table(|name, _| {
        let saved = SAVED.iter().find(|(saved, _)| *saved == name);
        saved.expect("each type of index has a file").1.to_vec()
    });
    table.compare();
    table
}

#[cfg(not(target_family = "wasm"))]
fn main() -> std::process::ExitCode {
    if std::env::var_os("P2M_BLESS").is_some() {
        let write = |name: &str, bytes: &[u8]| {
            std::fs::write(format!("{FOLDER}/{name}"), bytes).expect("a folder to write to");
        };
        let table = table(|name, bytes| {
            write(name, &bytes);
            bytes
        });
        write("checksums.txt", table.text().as_bytes());
        return std::process::ExitCode::SUCCESS;
    }
    let table = compared_table();
    println!("{}", table.report());
    u8::from(!table.faults.is_empty()).into()
}

/// The functions of the WebAssembly module, which has no files and prints nothing. `node.mjs` calls them.
#[cfg(target_family = "wasm")]
mod module {
    use std::sync::OnceLock;

    static REPORT: OnceLock<(usize, String)> = OnceLock::new();

    fn report() -> &'static (usize, String) {
        REPORT.get_or_init(|| {
            let table = super::compared_table();
            (table.faults.len(), table.report())
        })
    }

    #[unsafe(no_mangle)]
    extern "C" fn p2m_fault_count() -> usize {
        report().0
    }

    #[unsafe(no_mangle)]
    extern "C" fn p2m_report() -> *const u8 {
        report().1.as_ptr()
    }

    #[unsafe(no_mangle)]
    extern "C" fn p2m_report_length() -> usize {
        report().1.len()
    }
}

#[cfg(target_family = "wasm")]
fn main() {}

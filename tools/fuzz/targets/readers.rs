//! The fuzz target of readers. The environment variable `P2M_READER` names the reader.
#![no_main]

use p2m_fuzz::readers::Reader;
use std::sync::LazyLock;

static READER: LazyLock<Reader> = LazyLock::new(|| {
    let name = std::env::var("P2M_READER").unwrap_or_default();
    Reader::all().into_iter().find(|reader| reader.name() == name).expect("P2M_READER is the name of a reader")
});

libfuzzer_sys::fuzz_target!(|file: &[u8]| READER.check(file));

#![no_main]
libfuzzer_sys::fuzz_target!(|file: &[u8]| p2m_fuzz::readers::points(file, p2m_mixed::PointFormat::Npy));

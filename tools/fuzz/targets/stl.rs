#![no_main]
libfuzzer_sys::fuzz_target!(|file: &[u8]| p2m_fuzz::readers::scene(file, p2m_mixed::Format::Stl));

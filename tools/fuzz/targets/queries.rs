#![no_main]
libfuzzer_sys::fuzz_target!(|input: &[u8]| {
    p2m_fuzz::queries::check(input);
});

extern "C" int calx_placeholder_nvrtc() { return 0; }

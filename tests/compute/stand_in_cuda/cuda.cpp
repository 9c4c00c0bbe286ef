extern "C" int calx_placeholder_cuda() { return 0; }

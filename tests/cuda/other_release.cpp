// Stands in for nvJitLink of another release: all the functions, and the version 1.2.
extern "C" {
int nvJitLinkVersion(unsigned int* major, unsigned int* minor);
int nvJitLinkVersion(unsigned int* major, unsigned int* minor) {
    *major = 1;
    *minor = 2;
    return 0;
}
#define TANDEM_FUNCTION(name) \
    int name();               \
    int name() { return 1; }
TANDEM_FUNCTION(nvJitLinkCreate)
TANDEM_FUNCTION(nvJitLinkDestroy)
TANDEM_FUNCTION(nvJitLinkAddData)
TANDEM_FUNCTION(nvJitLinkComplete)
TANDEM_FUNCTION(nvJitLinkGetLinkedCubinSize)
TANDEM_FUNCTION(nvJitLinkGetLinkedCubin)
TANDEM_FUNCTION(nvJitLinkGetErrorLogSize)
TANDEM_FUNCTION(nvJitLinkGetErrorLog)
TANDEM_FUNCTION(nvJitLinkGetInfoLogSize)
TANDEM_FUNCTION(nvJitLinkGetInfoLog)
#undef TANDEM_FUNCTION
}

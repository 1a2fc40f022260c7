// SPDX-License-Identifier: GPL-2.0-or-later
// libavformat around one stream of libavcodec. Same frames, same bytes: a fixed number of threads,
// no date, no name of an encoder. libav prints what it meets; here it is told to be silent.
#include "io/video/video_file.h"

#include "base/memory.h"
#include "base/transfer.h"
#include "io/files/own_list.h"
#include "io/files/part_file.h"

#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

enum { THREADS = 2, BUFFER_SIZE = 1 << 16, GIF_TICKS = 100, PALETTE_SIZE = 256 };
enum { SIDE_BITS = 5, SIDE = 1 << SIDE_BITS };   // of the cube that colours are looked up in

// Kind of film for an ending of the name: libav's format and encoder, and options of the latter.
// Without a format each frame becomes a file of its own.
// The quality was chosen by eye, on thin lines and on the colours of a field.
typedef struct VideoKind {
    const char *ending, *format, *encoder, *name;
    enum AVPixelFormat pixels;
    const char *options[4][2];
} VideoKind;

static const VideoKind kinds[] = {
    {".mp4",
     "mp4",
     "libx264",
     "H.264",
     AV_PIX_FMT_YUV420P,
     {{"preset", "veryfast"}, {"crf", "18"}}},
    {".webm",
     "webm",
     "libvpx-vp9",
     "VP9",
     AV_PIX_FMT_YUV420P,
     {{"deadline", "realtime"}, {"cpu-used", "7"}, {"row-mt", "1"}, {"crf", "24"}}},
    {".gif", "gif", "gif", "GIF", AV_PIX_FMT_PAL8, {{0}}},
    {".png", NULL, "png", "PNG", AV_PIX_FMT_RGB24, {{"compression_level", "4"}, {"pred", "up"}}}};

struct VideoFile {
    const VideoModule *module;   // stands first
    char path[PATH_MAX];   // of PNGs their pattern
    bool overwrite;
    PartFile part;   // not of PNGs, like the next two and the track
    AVFormatContext *format;   // owned, like all
    AVIOContext *io;
    AVCodecContext *codec;
    AVStream *track;   // the format's
    AVFrame *frame;
    AVPacket *packet;
    struct SwsContext *scaler;   // NULL: of a GIF
    uint32_t palette[PALETTE_SIZE];
    uint8_t *nearest;   // [SIDE^3] entry of the palette by blue, green, red
    int write_errno;   // 0: all was written so far
    int64_t frames, pictures;   // encoded; PNGs written
    int log_level;   // libav's, as it was found
};

// --- the file ------------------------------------------------------------------------------------

// Since FFmpeg 7 (libavformat 61) what is written is const.
#if LIBAVFORMAT_VERSION_MAJOR >= 61
typedef const uint8_t WrittenByte;
#else
typedef uint8_t WrittenByte;
#endif

static int bytes_write(void *self, WrittenByte *bytes, int size)
{
    VideoFile *film = self;
    int cause = transfer_write(film->part.descriptor, bytes, size, -1);
    if (cause) film->write_errno = cause;
    return cause ? AVERROR(cause) : size;
}

static int64_t place_seek(void *self, int64_t offset, int whence)
{
    VideoFile *film = self;
    if (whence & AVSEEK_SIZE) return -1;
    return lseek(film->part.descriptor, offset, whence & ~AVSEEK_FORCE);
}

// Reports the error of libav, or that of the disk if writing failed.
static bool check(VideoFile *film, int code, const char *what, Error *err)
{
    char words[AV_ERROR_MAX_STRING_SIZE] = "";
    if (film->write_errno)
        return FAULT(err, ERROR_FILE, "film %s: cannot write: %s", film->path,
                     strerror(film->write_errno));
    if (code == AVERROR(ENOMEM)) return FAULT(err, ERROR_MEMORY, "no memory for libav");
    if (code < 0) {
        av_strerror(code, words, sizeof words);
        return FAULT(err, ERROR_LIBRARY, "film %s: libav %s: %s", film->path, what, words);
    }
    return true;
}

// --- begin ---------------------------------------------------------------------------------------

// Colours of video are those of BT.709, which is what players take for granted of HD.
static bool codec_open(VideoFile *film, const VideoKind *kind, const VideoDef *def, Error *err)
{
    AVDictionary *options = NULL;
    const AVCodec *encoder = avcodec_find_encoder_by_name(kind->encoder);
    if (!encoder)
        FAIL(err, ERROR_LIBRARY,
             "libav has no encoder %s here, which makes %s (%s); try another ending: .mp4, .webm, "
             ".gif, or a folder of PNG frames",
             kind->encoder, kind->ending, kind->name);
    film->codec = avcodec_alloc_context3(encoder);
    TRY(check(film, film->codec ? 0 : AVERROR(ENOMEM), "", err));
    AVCodecContext *codec = film->codec;
    codec->width = def->width;
    codec->height = def->height;
    codec->pix_fmt = kind->pixels;
    codec->time_base = (AVRational){1, def->rate};
    codec->framerate = (AVRational){def->rate, 1};
    codec->gop_size = 2 * def->rate;   // a viewer may jump to every other second
    codec->thread_count = THREADS;
    codec->flags |= AV_CODEC_FLAG_BITEXACT;
    if (film->format && film->format->oformat->flags & AVFMT_GLOBALHEADER)
        codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    if (kind->pixels == AV_PIX_FMT_YUV420P) {
        codec->colorspace = AVCOL_SPC_BT709;
        codec->color_primaries = AVCOL_PRI_BT709;
        codec->color_trc = AVCOL_TRC_BT709;
        codec->color_range = AVCOL_RANGE_MPEG;
    }
    for (int32_t k = 0; k < 4 && kind->options[k][0]; ++k)
        av_dict_set(&options, kind->options[k][0], kind->options[k][1], 0);
    TRY(check(film, avcodec_open2(codec, encoder, &options), "does not start its encoder", err));
cleanup:
    av_dict_free(&options);
    return error_is_clean(err);
}

// The nearest entry of the palette to the middle of each of SIDE^3 cubes of colours.
static bool palette_fill(VideoFile *film, const uint8_t *colors, Error *err)
{
    if (!(film->nearest = NEW_ARRAY(uint8_t, SIDE * SIDE * SIDE, err))) return false;
    for (int32_t k = 0; k + 1 < PALETTE_SIZE; ++k)   // the last one stays transparent
        film->palette[k] = 0xff000000u | (uint32_t)colors[3 * k] << 16 |
                           (uint32_t)colors[3 * k + 1] << 8 | colors[3 * k + 2];
    for (int32_t cube = 0; cube < SIDE * SIDE * SIDE; ++cube) {
        int32_t least = INT32_MAX, at[3];
        for (int32_t c = 0; c < 3; ++c)   // the ends of the range are themselves
            at[c] = ((cube >> SIDE_BITS * (2 - c)) % SIDE * 255 + SIDE / 2) / (SIDE - 1);
        for (int32_t k = 0; k + 1 < PALETTE_SIZE; ++k) {
            int32_t away = 0;
            for (int32_t c = 0; c < 3; ++c)
                away += (colors[3 * k + c] - at[c]) * (colors[3 * k + c] - at[c]);
            if (away >= least) continue;
            least = away;
            film->nearest[cube] = (uint8_t)k;
        }
    }
    return true;
}

static void film_destroy(VideoFile *film)
{
    if (!film) return;
    avcodec_free_context(&film->codec);
    av_frame_free(&film->frame);
    av_packet_free(&film->packet);
    sws_freeContext(film->scaler);
    avformat_free_context(film->format);
    if (film->io) av_freep(&film->io->buffer);
    avio_context_free(&film->io);
    av_log_set_level(film->log_level);
    part_file_discard(&film->part);
    memory_free_all(film->nearest, film);
}

// Name of the PNG of a frame, from 1, after a pattern "run-%04d.png", which is never handed to
// printf: a folder may be called "50% load". false: the pattern has not one number in its name.
static bool picture_path(const char *pattern, int64_t frame, char path[PATH_MAX])
{
    const char *slash = strrchr(pattern, '/'), *mark = strchr(slash ? slash : pattern, '%');
    char *end = NULL;
    long digits = mark ? strtol(mark + 1, &end, 10) : -1;
    if (digits < 0 || digits > 9 || *end != 'd' || strchr(end, '%')) return false;
    return snprintf(path, PATH_MAX, "%.*s%0*lld%s", (int)(mark - pattern), pattern, (int)digits,
                    (long long)frame, end + 1) < PATH_MAX;
}

// The kind of a film by its name; NULL and ERROR_INPUT: the name has none, or is too long. first:
// the name of the first PNG.
static const VideoKind *kind_find(const char *path, char first[PATH_MAX], Error *err)
{
    const VideoKind *kind = NULL;
    const char *dot = strrchr(path, '.');
    if (strlen(path) >= PATH_MAX) FAIL(err, ERROR_INPUT, "the name of the film is too long");
    for (size_t k = 0; dot && !kind && k < sizeof kinds / sizeof *kinds; ++k)
        if (strcasecmp(kinds[k].ending, dot) == 0) kind = &kinds[k];
    if (!kind || (!kind->format && !picture_path(path, 1, first)))
        FAIL(err, ERROR_INPUT,
             "%s: a film ends in .mp4, .webm or .gif; PNG frames go into a folder (frames/), or "
             "their name has one number and ends in .png (frames/run-%%04d.png)",
             path);
    return kind;
cleanup:
    return NULL;
}

static bool name_check(const char *path, Error *err)
{
    char first[PATH_MAX];
    return kind_find(path, first, err) != NULL;
}

static VideoFile *film_create(const VideoDef *def, Error *err)
{
    char url[4200], first[PATH_MAX];
    AVDictionary *options = NULL;
    const VideoKind *kind = kind_find(def->path, first, err);
    if (!kind) return NULL;
    VideoFile *film = NEW_ARRAY(VideoFile, 1, err);
    TRY(film);
    film->module = amontons_video_module();
    film->log_level = av_log_get_level();
    av_log_set_level(AV_LOG_QUIET);
    snprintf(film->path, sizeof film->path, "%s", def->path);
    film->overwrite = def->overwrite;
    if (!kind->format && access(first, F_OK) == 0 && !def->overwrite)
        FAIL(err, ERROR_INPUT,
             "%s is there already: name another folder, say --overwrite, or remove those frames",
             first);
    if (kind->pixels == AV_PIX_FMT_PAL8 && GIF_TICKS % def->rate != 0)
        FAIL(err, ERROR_INPUT,
             "%d frames a second: a GIF counts hundredths of a second, so 10, 20, 25 or 50",
             def->rate);
    if (kind->pixels == AV_PIX_FMT_PAL8) TRY(palette_fill(film, def->palette, err));
    if (kind->format) {
        TRY(part_file_replace(&film->part, def->path, def->overwrite, err));

        // The file. Its name is asked once more, to move the index of an .mp4 to its front; "file:"
        // keeps a colon in it from being taken for a protocol.
        snprintf(url, sizeof url, "file:%s", film->part.part);
        TRY(check(film, avformat_alloc_output_context2(&film->format, NULL, kind->format, url),
                  "makes no such file", err));
        uint8_t *buffer = av_malloc(BUFFER_SIZE);
        if (buffer)
            film->io =
                avio_alloc_context(buffer, BUFFER_SIZE, 1, film, NULL, bytes_write, place_seek);
        if (!film->io) av_free(buffer);
        TRY(check(film, film->io ? 0 : AVERROR(ENOMEM), "", err));
        film->format->pb = film->io;
        film->format->flags |= AVFMT_FLAG_BITEXACT;
    }

    TRY(codec_open(film, kind, def, err));

    // The file's own frames and their way from what is drawn.
    film->frame = av_frame_alloc();
    film->packet = av_packet_alloc();
    TRY(check(film, film->frame && film->packet ? 0 : AVERROR(ENOMEM), "", err));
    film->frame->format = kind->pixels;
    film->frame->width = def->width;
    film->frame->height = def->height;
    TRY(check(film, av_frame_get_buffer(film->frame, 0), "has no frame", err));
    if (kind->pixels != AV_PIX_FMT_PAL8) {
        film->scaler = sws_getContext(def->width, def->height, AV_PIX_FMT_BGR0, def->width,
                                      def->height, kind->pixels, SWS_BILINEAR, NULL, NULL, NULL);
        TRY(check(film, film->scaler ? 0 : AVERROR(ENOMEM), "", err));
        const int *hd = sws_getCoefficients(SWS_CS_ITU709);
        sws_setColorspaceDetails(film->scaler, hd, 1, hd, 0, 0, 1 << 16, 1 << 16);
    }

    // The one stream in it, and the header.
    if (!kind->format) return film;
    film->track = avformat_new_stream(film->format, NULL);
    TRY(check(film, film->track ? 0 : AVERROR(ENOMEM), "", err));
    film->track->time_base = film->codec->time_base;
    film->track->avg_frame_rate = film->codec->framerate;
    TRY(check(film, avcodec_parameters_from_context(film->track->codecpar, film->codec),
              "describes no stream", err));
    av_dict_set(&options, "movflags", "+faststart", 0);   // others do not know it
    av_dict_set(&film->format->metadata, "comment", "made by amontons " AMONTONS_VERSION, 0);
    if (def->title && def->title[0]) av_dict_set(&film->format->metadata, "title", def->title, 0);
    TRY(check(film, avformat_write_header(film->format, &options), "writes no header", err));
cleanup:
    av_dict_free(&options);
    if (error_is_clean(err)) return film;
    film_destroy(film);
    return NULL;
}

// --- frames --------------------------------------------------------------------------------------

// All that the encoder has ready goes into the file.
static bool packets_write(VideoFile *film, Error *err)
{
    for (;;) {
        int code = avcodec_receive_packet(film->codec, film->packet);
        if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return true;
        if (!check(film, code, "cannot encode a frame", err)) return false;
        if (!film->format) {
            char path[PATH_MAX];
            if (!picture_path(film->path, ++film->pictures, path))
                return FAULT(err, ERROR_INPUT, "%s: the name of frame %lld is too long", film->path,
                             (long long)film->pictures);
            if (!part_file_put(path, film->overwrite, film->packet->data, film->packet->size, err))
                return false;
            continue;
        }
        if (film->packet->duration <= 0) film->packet->duration = 1;   // frame
        av_packet_rescale_ts(film->packet, film->codec->time_base, film->track->time_base);
        film->packet->stream_index = film->track->index;
        code = av_interleaved_write_frame(film->format, film->packet);
        if (!check(film, code, "cannot write a frame", err)) return false;
    }
    return true;
}

static bool film_add(VideoFile *film, const uint8_t *pixels, int32_t stride, Error *err)
{
    enum { DROP = 8 - SIDE_BITS };   // bits of a colour's part
    AVFrame *frame = film->frame;
    if (!check(film, av_frame_make_writable(frame), "has no frame", err)) return false;
    if (film->scaler)
        sws_scale(film->scaler, (const uint8_t *const[]){pixels}, &stride, 0, frame->height,
                  frame->data, frame->linesize);
    else
        memcpy(frame->data[1], film->palette, sizeof film->palette);
    for (int32_t row = 0; !film->scaler && row < frame->height; ++row) {
        const uint8_t *from = pixels + (int64_t)row * stride;
        uint8_t *to = frame->data[0] + (int64_t)row * frame->linesize[0];
        for (int32_t k = 0; k < frame->width; ++k, from += 4)
            to[k] = film->nearest[(from[2] >> DROP) << 2 * SIDE_BITS |
                                  (from[1] >> DROP) << SIDE_BITS | from[0] >> DROP];
    }
    frame->pts = film->frames++;
    return check(film, avcodec_send_frame(film->codec, frame), "cannot encode a frame", err) &&
           packets_write(film, err);
}

static bool film_finish(VideoFile *film, Error *err)
{
    if (!check(film, avcodec_send_frame(film->codec, NULL), "cannot end the film", err))
        return false;
    if (!packets_write(film, err)) return false;

    // PNGs of a longer film of ours, in a folder of ours, would seem to be of this one. They stay
    // where the folder's list cannot be read: all frames of this film are written.
    bool ours = film->overwrite;
    Error unseen = {0};
    while (!film->format && ours) {
        char path[PATH_MAX];
        ours = picture_path(film->path, ++film->pictures, path) &&
               own_list_has(path, &ours, &unseen) && ours && unlink(path) == 0;
    }
    if (!film->format) return true;
    if (!check(film, av_write_trailer(film->format), "cannot end the file", err)) return false;
    avio_flush(film->io);
    return check(film, film->io->error, "cannot end the file", err) &&
           part_file_commit(&film->part, err);
}

__attribute__((visibility("default"))) const VideoModule *amontons_video_module(void)
{
    static const VideoModule module = {name_check, film_create, film_add, film_finish,
                                       film_destroy};
    return &module;
}
